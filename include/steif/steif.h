/* steif/steif.h: the solver library. Beside it stand <steif/data.h>: problems and files,
 * <steif/linear.h>: E x' + F x = f, and <steif/analysis.h>: about a method, a problem, a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_STEIF_H
#define STEIF_STEIF_H

#include <steif/base.h>
#include <steif/problem.h>
#include <steif/gradient.h>
#include <steif/hessian.h>
#include <steif/index.h>
#include <steif/consistent.h>
#include <steif/direction.h>
#include <steif/initial.h>
#include <steif/krylov.h>
#include <steif/layout.h>
#include <steif/method.h>
#include <steif/parameters.h>
#include <steif/pencil.h>
#include <steif/phi.h>
#include <steif/record.h>
#include <steif/quadrature.h>
#include <steif/sensitivity.h>
#include <steif/solver.h>
#include <steif/checkpoint.h>
#include <steif/table.h>
#include <steif/glm.h>

#endif
