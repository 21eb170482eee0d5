"""Runs jobs in a few processes, one thread each, and shows the progress."""

import concurrent.futures
import sys
import time


def spread(function, jobs, *, workers=2, name="jobs"):
    """A list of function(job) for every job, in order; writes the progress to standard error."""
    began, results = time.monotonic(), []
    with concurrent.futures.ProcessPoolExecutor(workers) as pool:
        for result in pool.map(function, jobs):
            results.append(result)
            done, count = len(results), len(jobs)
            if done % max(1, count // 10) == 0 or done == count:
                seconds = time.monotonic() - began
                print(f"{name}: {done} of {count}, {seconds:.0f} s", file=sys.stderr, flush=True)
    return results
