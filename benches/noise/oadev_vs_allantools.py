"""Overlapping Allan deviation at 22 octaves of 10 million readings: Tumble beside allantools, one core, one machine, in turn.

    cargo build --release -p tumble-core --example oadev
    python3 -m venv .tools/bench && .tools/bench/bin/pip install allantools==2024.6
    .tools/bench/bin/python benches/noise/oadev_vs_allantools.py

Both compute from readings in memory, every place used (full overlap), the same averaging times; the deviations are compared
before anything is timed. Beside them two floors: a pass that sums the readings, and a running sum of them that is kept.
"""
import os
import pathlib
import re
import statistics
import subprocess
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import allantools
import numpy as np

TARGET = os.environ.get("CARGO_TARGET_DIR") or pathlib.Path(__file__).resolve().parents[2] / "target"
EXAMPLE = pathlib.Path(TARGET) / "release/examples/oadev"
READINGS = 10_000_000
OCTAVES = 22
TURNS = 5


def readings():
    """The generator of NBS14, as in the example."""
    state, out = 1_234_567_890, np.empty(READINGS)
    for i in range(READINGS):
        state = 16_807 * state % 2_147_483_647
        out[i] = state / 2_147_483_647
    return out


def ours():
    text = subprocess.run([EXAMPLE, str(READINGS)], check=True, capture_output=True, text=True).stdout
    rounds = [dict(re.findall(r"(\w+) ([-\d.e+]+)", line.split(":")[1])) for line in text.splitlines()]
    return {k: statistics.median(float(r[k]) for r in rounds) for k in rounds[0]}


def main():
    y = readings()
    taus = 2.0 ** np.arange(OCTAVES)
    turns = []
    for turn in range(TURNS):
        own = ours()
        start = time.perf_counter()
        _, deviations, _, _ = allantools.oadev(y, rate=1.0, data_type="freq", taus=taus)
        theirs = time.perf_counter() - start
        start = time.perf_counter()
        np.cumsum(y)
        cumsum = time.perf_counter() - start
        for name, value in (("first", deviations[0]), ("last", deviations[-1])):
            assert abs(own[name] / value - 1) < 1e-8, (name, own[name], value)
        turns.append((own, theirs, cumsum))
        print(f"turn {turn}: allantools {theirs:.3f} s, octaves {own['octaves']:.4f} s, ratio {theirs / own['octaves']:.1f}")
    middle = lambda of: statistics.median(of(t) for t in turns)
    print(f"allantools {allantools.__version__}: {middle(lambda t: t[1]):.3f} s")
    for key, name in (
        ("octaves", "allan_octaves"), ("velocity", "Velocity, then variances"), ("stream", "VarianceStream (bounded memory)"),
        ("sum", "floor: sum of the readings"), ("prefix", "floor: running sum, kept"),
    ):
        print(f"{name}: {1e3 * middle(lambda t: t[0][key]):.1f} ms")
    print(f"floor: numpy.cumsum: {1e3 * middle(lambda t: t[2]):.1f} ms")
    print(f"ratio, median of {TURNS} turns: {middle(lambda t: t[1] / t[0]['octaves']):.1f}")


main()
