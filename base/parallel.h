// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "delquad/options.h"

// This header has parallel loops. All modules use it.

namespace delquad {

/// Returns the number of threads of parallel_for(): of the run (context.h), or the number of cores outside of
/// runs.
int thread_count();

/// Ends waiting threads, as needed before a process forks; the next parallel_for() starts new ones. No other
/// thread of the program may use oneTBB, and no parallel_for() may run.
void finish_threads();

/// Calls work(i) once for each i in [0, n) on thread_count() threads, and waits. Calls with a higher `cost`
/// (any unit) start first, equal ones in order. Each call must write only to the data of its own i, so that
/// the number of threads does not matter. After an exception the other calls still run, and the exception of
/// the smallest i is thrown. If the run is cancelled, calls that have not started are left out. Calls may use
/// parallel_for() themselves.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& work,
                  const std::function<double(std::size_t)>& cost = {});

/// Calls work(begin, end) by parallel_for() for ranges of 1024 items (the last may be shorter) that cover [0,
/// n).
void parallel_ranges(std::size_t n, const std::function<void(std::size_t begin, std::size_t end)>& work);

/// Returns seconds: of the clock, and of the processor for this thread and others in its parallel_for()
/// calls, nested ones included. Only differences are meaningful. Stopwatch uses it.
TimeSpent time_spent();

}  // namespace delquad
