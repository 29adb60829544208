"""Whole-process time of `tumble certify` beside pandas and numpy doing the least of it: read, average, solve.

    cargo build --release
    python3 -m venv .tools/bench && .tools/bench/bin/pip install pandas
    .tools/bench/bin/python benches/certify_vs_pandas.py

Simulates the paper's bench (5 runs of 60 dwells of 1500 codes, plain CSV), then runs both in turn, eleven times each,
and prints medians and the ratio pair by pair. tumble also judges, writes the passport, the page and the figures;
the peer's estimates are compared with the passport's before anything is timed.
"""
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

TUMBLE = pathlib.Path(__file__).resolve().parent.parent / "target/release/tumble"
PEER = """
import sys, pathlib
import numpy as np, pandas as pd
for f in sorted(pathlib.Path(sys.argv[1]).glob("run-*.csv")):
    d = pd.read_csv(f).groupby("angle_deg", sort=False)["code"].mean()
    a, n = np.radians(d.index.to_numpy()), d.to_numpy()
    y = n + 0.5 * np.sign(n)
    al, be, ga = np.linalg.lstsq(np.c_[np.ones_like(a), np.sin(a), np.cos(a)], y, rcond=None)[0]
    k = 9.81 / np.hypot(be, ga)
    print(al * k, np.arctan2(ga, be), k / 0.00769 - 1)
"""


def timed(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


def main():
    with tempfile.TemporaryDirectory() as folder:
        bench, out = f"{folder}/bench", f"{folder}/out"
        subprocess.run([TUMBLE, "simulate", bench, "--preset", "paper-3", "--seed", "3"], check=True)
        passport = json.loads(
            subprocess.run([TUMBLE, "certify", bench, "--weights", "equal", "--json"], check=True, capture_output=True).stdout
        )
        theirs = subprocess.run([sys.executable, "-c", PEER, bench], check=True, capture_output=True, text=True).stdout
        for run, line in zip(passport["runs"], theirs.splitlines(), strict=True):
            ours = [run["estimates"][p]["value"] for p in passport["parameters"]]
            assert all(abs(a - float(b)) <= 1e-9 * abs(a) + 1e-13 for a, b in zip(ours, line.split())), (ours, line)
        pairs = []
        for _ in range(12):
            shutil.rmtree(out, ignore_errors=True)
            pairs.append((timed([TUMBLE, "certify", bench, "--out", out]), timed([sys.executable, "-c", PEER, bench])))
        pairs = pairs[1:]  # the first warms the caches
        ours, peer = (statistics.median(p[i] for p in pairs) for i in (0, 1))
        ratio = statistics.median(p[1] / p[0] for p in pairs)
        print(f"tumble certify with page and figures  {ours * 1e3:7.1f} ms")
        print(f"pandas and numpy, estimates alone     {peer * 1e3:7.1f} ms")
        print(f"ratio, median of pairs                {ratio:7.1f}")


main()
