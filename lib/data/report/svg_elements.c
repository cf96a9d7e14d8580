/* svg_elements.c: numbers, texts and lines as SVG writes them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include "svg_elements.h"

void stf_svg_number(FILE *out, double value)
{
  char text[40];
  stf_report_number(text, sizeof text, 'f', 2, value);
  fputs(text, out);
}

void stf_svg_attribute(FILE *out, const char *name, double value)
{
  fprintf(out, " %s=\"", name);
  stf_svg_number(out, value);
  putc('"', out);
}

/* The length of a well-formed UTF-8 character at `text`; 0 when it is not one. */
static int character(const unsigned char *text)
{
  const int length = *text < 0x80                    ? 1
                     : *text >= 0xC2 && *text < 0xE0 ? 2
                     : *text >= 0xE0 && *text < 0xF0 ? 3
                     : *text >= 0xF0 && *text < 0xF5 ? 4
                                                     : 0;
  for (int i = 1; i < length; i++)
    if ((text[i] & 0xC0) != 0x80) return 0;
  return length;
}

void stf_svg_escaped(FILE *out, const char *text)
{
  while (*text) {
    const int length = character((const unsigned char *)text);
    if (length == 0 || (length == 1 && (unsigned char)*text < ' '))
      putc('?', out);
    else if (*text == '<')
      fputs("&lt;", out);
    else if (*text == '>')
      fputs("&gt;", out);
    else if (*text == '&')
      fputs("&amp;", out);
    else if (*text == '"')
      fputs("&quot;", out);
    else
      fwrite(text, 1, (size_t)length, out);
    text += length ? length : 1;
  }
}

void stf_svg_words(FILE *out, double x, double y, const char *style, const char *text)
{
  if (!text || !*text) return;
  fputs("<text", out);
  stf_svg_attribute(out, "x", x);
  stf_svg_attribute(out, "y", y);
  fprintf(out, " %s>", style);
  stf_svg_escaped(out, text);
  fputs("</text>\n", out);
}

void stf_svg_segment(FILE *out, double x1, double y1, double x2, double y2, const char *style)
{
  fputs("<line", out);
  stf_svg_attribute(out, "x1", x1);
  stf_svg_attribute(out, "y1", y1);
  stf_svg_attribute(out, "x2", x2);
  stf_svg_attribute(out, "y2", y2);
  fprintf(out, " %s/>\n", style);
}
