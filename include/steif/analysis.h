/* steif/analysis.h: stability regions and orders, Lyapunov exponents, energy, failures, fits.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_ANALYSIS_H
#define STEIF_ANALYSIS_H

#include <steif/region.h>
#include <steif/counterexample.h>
#include <steif/lyapunov.h>
#include <steif/decay.h>
#include <steif/supervisor.h>
#include <steif/energy.h>
#include <steif/hamiltonian.h>
#include <steif/ensemble.h>
#include <steif/failure.h>
#include <steif/fit.h>

#endif
