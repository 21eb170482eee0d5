"""Runs jobs in a few processes, one thread each, and shows the progress."""

import concurrent.futures
import sys
import time


def spread(function, jobs, *, workers=2, name="jobs"):
    """A list of function(job) for every job, in order; writes the progress to standard error."""
    began, results = time.monotonic(), {}
    if workers == 1:
        for i, job in enumerate(jobs):
            results[i] = function(job)
            tell(name, len(results), len(jobs), began)
    else:
        with concurrent.futures.ProcessPoolExecutor(workers) as pool:
            waiting = {pool.submit(function, job): i for i, job in enumerate(jobs)}
            for done in concurrent.futures.as_completed(waiting):
                results[waiting[done]] = done.result()
                tell(name, len(results), len(jobs), began)
    return [results[i] for i in range(len(jobs))]


def tell(name, done, count, began):
    if done % max(1, count // 10) == 0 or done == count:
        seconds = time.monotonic() - began
        print(f"{name}: {done} of {count}, {seconds:.0f} s", file=sys.stderr, flush=True)
