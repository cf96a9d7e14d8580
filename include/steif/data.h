/* steif/data.h: the collection of problems, matrices and expressions from files, reports.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_DATA_H
#define STEIF_DATA_H

#include <steif/collection.h>
#include <steif/forcing.h>
#include <steif/input.h>
#include <steif/model.h>
#include <steif/report.h>

#endif
