#pragma once

#include <cstddef>
#include <functional>

#include "delquad/options.h"

namespace delquad {

/// Threads that parallel_for() uses here: those of the run (see context.h); outside of runs as many as the
/// machine has cores.
int thread_count();

/// Ends the threads that wait for work, as is necessary before a process forks; the next parallel_for()
/// starts new ones. Only where no other thread of the program uses oneTBB, as in the command line; not while
/// a parallel_for() runs.
void finish_threads();

/// Calls work(i) once for each i in [0, n), on thread_count() threads, and returns when all are done. `cost`
/// (any unit) tells which are to begin first, so that the large ones do not end up alone; equal costs begin
/// in order. Each call must write only to what belongs to its own i: then the result is the same for every
/// number of threads. Where calls throw, the others run nevertheless, and the exception of the smallest i is
/// thrown on; only when the run is cancelled those that have not begun do not. Calls may use parallel_for()
/// themselves.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& work,
                  const std::function<double(std::size_t)>& cost = {});

/// Calls work(begin, end) for ranges of a fixed length, the last one excepted, that make up [0, n).
void parallel_ranges(std::size_t n, const std::function<void(std::size_t begin, std::size_t end)>& work);

/// The clock, and the processor time of this thread and of others while they worked in its parallel_for()
/// calls (nested ones included): differences mean something. For measuring: see Stopwatch.
TimeSpent time_spent();

}  // namespace delquad
