/* program.h: what all verbs of the program share: the command line, sentences, output.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PROGRAM_H
#define PROGRAM_H

#include "command_line.h"
#include "interruption.h"
#include "message.h"
#include "output.h"
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>

#endif
