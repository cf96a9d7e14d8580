/* steif/steif.h: all of steif.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_STEIF_H
#define STEIF_STEIF_H

#include <steif/base.h>
#include <steif/bench.h>
#include <steif/collection.h>
#include <steif/counterexample.h>
#include <steif/descriptor.h>
#include <steif/diagnose.h>
#include <steif/discrete.h>
#include <steif/energy.h>
#include <steif/experiment.h>
#include <steif/failure.h>
#include <steif/hamiltonian.h>
#include <steif/glm.h>
#include <steif/impulse.h>
#include <steif/input.h>
#include <steif/jump.h>
#include <steif/lyapunov.h>
#include <steif/method.h>
#include <steif/pencil.h>
#include <steif/phi.h>
#include <steif/problem.h>
#include <steif/record.h>
#include <steif/report.h>
#include <steif/solver.h>
#include <steif/stability.h>
#include <steif/supervisor.h>
#include <steif/table.h>

#endif
