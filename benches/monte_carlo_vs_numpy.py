"""Monte Carlo draws of a whole budget beside the same draws in numpy, in one run.

    cargo build --release -p tumble-core --example monte_carlo
    python3 -m venv .tools/bench && .tools/bench/bin/pip install numpy
    .tools/bench/bin/python benches/monte_carlo_vs_numpy.py

Fourteen inputs (a multivariate Student block of three, six normal, four rectangular, one arcsine), four outputs, the
probabilistically symmetric and the shortest 95 % interval of each. Both must find the same intervals within the error of
the draws. Medians of five runs that alternate; the product on two threads and on one, numpy as it comes.
"""
import pathlib
import re
import statistics
import subprocess
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "target/release/examples/monte_carlo"
N = 1_000_000
# As in crates/tumble-core/examples/monte_carlo.rs.
S = np.array([
    [0, 0, 0.737], [0, 0, 0.65], [-5.1, 0.83, 0], [1.6e-3, 1.1e-5, 0], [2e-5, 0, 3e-5],
    [-71, 9.5, 0], [0, 0, 61], [0.5, 0.01, 1],
])
R = np.array([[1, -0.975, 0], [-0.975, 1, 0], [0, 0, 1]])


def draws(rng):
    root = np.linalg.cholesky(R)
    width = np.sqrt(rng.chisquare(57, N) / 57)
    block = root @ rng.standard_normal((3, N)) / width
    linear = np.array([[-0.0063], [0.002], [0.001]]) + np.array([[9e-4], [1.1e-4], [3.5e-5]]) * block
    gravity = 1 + rng.uniform(-5e-4, 5e-4, N) / 9.81
    psi, eta = 8.7e-3 * rng.standard_normal((2, N))
    x = np.empty((8, N))
    x[0] = 7.7e-4 * rng.standard_normal(N)
    x[1:3] = 6.2e-4 * rng.standard_normal((2, N))
    x[3] = 0.3 * np.cos(2 * np.pi * rng.random(N))
    x[4] = rng.uniform(-0.2, 0.2, N)
    x[5] = 1e-5 * rng.standard_normal(N)
    x[6] = 1e-6 * rng.standard_normal(N)
    x[7] = rng.uniform(-1e-3, 1e-3, N)
    linear += S.T @ x
    scale = (1 + linear[2] - (psi**2 + eta**2) / 2) * gravity - 1
    bias = (linear[0] + 9.81 * psi * eta) * gravity
    return np.stack([bias, linear[1], scale, (1 + scale) * 0.00769])


def intervals(y):
    out = []
    inside = round(0.95 * N)
    for row in y:
        row = np.sort(row)
        low, high = row[(N - inside) // 2], row[(N + inside) // 2]
        i = np.argmin(row[inside:] - row[: N - inside])
        out.append((row.mean(), row.std(ddof=1), low, high, row[i], row[i + inside]))
    np.cov(y)
    return out


def product(threads):
    text = subprocess.run([EXAMPLE, str(N), str(threads)], capture_output=True, text=True, check=True).stdout
    seconds = [float(s) for s in re.findall(r": ([0-9.]+) s;", text)]
    found = re.search(r"u ([0-9.]+) m/s2, 95 % \[([-0-9.]+), ([-0-9.]+)\]", text)
    return min(seconds), [float(v) for v in found.groups()]


def main():
    times = {"numpy": [], "two threads": [], "one thread": []}
    rng = np.random.default_rng(1)
    for _ in range(5):
        start = time.perf_counter()
        theirs = intervals(draws(rng))[0]
        times["numpy"].append(time.perf_counter() - start)
        for name, threads in (("two threads", 2), ("one thread", 1)):
            seconds, ours = product(threads)
            times[name].append(seconds)
    print(f"bias, numpy:  u {theirs[1]:.6f} m/s2, 95 % [{theirs[2]:.5f}, {theirs[3]:.5f}]")
    print(f"bias, tumble: u {ours[0]:.6f} m/s2, 95 % [{ours[1]:.5f}, {ours[2]:.5f}]")
    assert abs(ours[0] / theirs[1] - 1) < 0.01
    medians = {name: statistics.median(t) for name, t in times.items()}
    for name, t in medians.items():
        print(f"{name:12} {t:.3f} s   {medians['numpy'] / t:.1f} times numpy's speed")


if __name__ == "__main__":
    main()
