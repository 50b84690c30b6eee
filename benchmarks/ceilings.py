"""What the machine can do at most: bytes and multiply-adds a second, by kernels that do nothing else."""

from __future__ import annotations

import argparse
import time
from statistics import median

import numba
import numpy as np
from numba import prange

from mpmkit.kernels.compile import kernel
from mpmkit.kernels.vectors import lane, pack, plus

LENGTH = 1 << 25
"""Doubles of an array: 256 MiB, more than any cache."""
FUSED = 1 << 18
"""Multiply-adds of vectors a chunk."""


@kernel()
def triad(a, b, c):
    for i in prange(len(a)):
        a[i] = b[i] + 3.0 * c[i]


@kernel()
def multiply_add(out):
    for chunk in prange(len(out)):
        x = 1e-9 * chunk
        a = b = c = d = e = f = g = h = pack(x, x, x, x, x, x, x, x)
        for _ in range(FUSED // 8):  # eight that do not wait for one another
            a, b, c, d = plus(a, 0.5, a), plus(b, 0.5, b), plus(c, 0.5, c), plus(d, 0.5, d)
            e, f, g, h = plus(e, 0.5, e), plus(f, 0.5, f), plus(g, 0.5, g), plus(h, 0.5, h)
        out[chunk] = lane(a, 0) + lane(b, 0) + lane(c, 0) + lane(d, 0)
        out[chunk] += lane(e, 0) + lane(f, 0) + lane(g, 0) + lane(h, 0)


def seconds(run, *arguments) -> float:
    run(*arguments)
    taken = []
    for _ in range(7):
        start = time.perf_counter()
        run(*arguments)
        taken.append(time.perf_counter() - start)
    return median(taken)


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    a, b, c = (np.ones(LENGTH) for _ in range(3))
    out = np.zeros(16)
    print("| threads | triad, GB/s | multiply-adds of vectors, G/s | GFlop/s |")
    print("|---|---|---|---|")
    for threads in sorted({1, numba.config.NUMBA_NUM_THREADS}):
        numba.set_num_threads(threads)
        moved = 4 * 8 * LENGTH / seconds(triad, a, b, c)  # what is written is read first
        fused = FUSED * len(out) / seconds(multiply_add, out)
        print(f"| {threads} | {moved / 1e9:.1f} | {fused / 1e9:.2f} | {16 * fused / 1e9:.0f} |")


if __name__ == "__main__":
    main()
