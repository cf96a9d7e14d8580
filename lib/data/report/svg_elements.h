/* svg_elements.h: numbers, texts and lines as SVG writes them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SVG_ELEMENTS_H
#define STF_SVG_ELEMENTS_H

#include <stdio.h>

/* With two decimals. */
void stf_svg_number(FILE *out, double value);
/* name="value" with a leading blank. */
void stf_svg_attribute(FILE *out, const char *name, double value);
/* A text with the characters of XML escaped; bytes that are no UTF-8 become question marks. */
void stf_svg_escaped(FILE *out, const char *text);
/* A <text> element; nothing for an empty one. */
void stf_svg_words(FILE *out, double x, double y, const char *style, const char *text);
/* A <line> element. */
void stf_svg_segment(FILE *out, double x1, double y1, double x2, double y2, const char *style);

#endif
