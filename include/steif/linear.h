/* steif/linear.h: descriptor systems E x' + F x = f of any index, and linear discretisation.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_LINEAR_H
#define STEIF_LINEAR_H

#include <steif/impulse.h>
#include <steif/slopes.h>
#include <steif/team.h>
#include <steif/eigenvalues.h>
#include <steif/jump.h>
#include <steif/runs.h>
#include <steif/weak.h>
#include <steif/discrete.h>

#endif
