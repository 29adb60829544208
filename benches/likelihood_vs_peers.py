"""The likelihood's fit beside statsmodels and odrpack, in one run: what they find, and how long they take.

    cargo build --release && cargo build --release -p tumble-core --example fit_time
    python3 -m venv .tools/bench && .tools/bench/bin/pip install numpy statsmodels odrpack matplotlib
    .tools/bench/bin/python benches/likelihood_vs_peers.py

1. Values: one simulated bench of the paper (60 dwells of 1500 codes, angle scatter 3 arcmin, noise 1.25 LSB). On the
   dwell means, statsmodels' WLS with the weights 1/(s²/n + (R cosφ σφ)²), and odrpack's errors in angle and reading;
   `tumble certify` with the exact form and the likelihood. All know the same σφ (`--weights stated`), so they must
   agree within a small part of the standard uncertainty.
2. Time of one fit after reading, one core, medians: the likelihood on histograms at 1.25 and 0.1 LSB of noise, the
   peers on the averages. Then the cost against positions and samples; the plot goes to docs/figures/cost.svg.
"""
import csv
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

# One core for everybody.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import matplotlib
import numpy as np
import statsmodels.api as sm
from odrpack import odr_fit

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parent.parent
TUMBLE = ROOT / "target/release/tumble"
FIT_TIME = ROOT / "target/release/examples/fit_time"
G, K0, SIGMA_PHI = 9.81, 0.00769, np.radians(3 / 60)


def parameters(alpha, beta, gamma):
    k = G / np.hypot(beta, gamma)
    return alpha * k, np.arctan2(gamma, beta), k / K0 - 1


def model(phi, b):
    return b[0] + b[1] * np.sin(phi) + b[2] * np.cos(phi)


def read(folder):
    codes = {}
    with open(f"{folder}/run-1.csv", encoding="utf-8") as f:
        for row in csv.DictReader(line for line in f if not line.startswith("#")):
            codes.setdefault(float(row["angle_deg"]), []).append(int(row["code"]))
    phi = np.radians(list(codes))
    mean = np.array([np.mean(c) for c in codes.values()])
    u = np.array([np.std(c, ddof=1) / np.sqrt(len(c)) for c in codes.values()])
    return phi, mean + 0.5 * np.sign(mean), u


def by_statsmodels(phi, y, u):
    x = np.column_stack([np.ones_like(phi), np.sin(phi), np.cos(phi)])
    b = np.array([0.0, G / K0, 0.0])
    for _ in range(3):  # the weights hold the solution
        slope = b[1] * np.cos(phi) - b[2] * np.sin(phi)
        fit = sm.WLS(y, x, weights=1 / (u**2 + (slope * SIGMA_PHI) ** 2)).fit()
        b = fit.params
    return parameters(*b)


def by_odrpack(phi, y, u):
    start = np.array([0.0, G / K0, 0.0])
    fit = odr_fit(model, phi, y, start, weight_x=np.full_like(phi, SIGMA_PHI**-2), weight_y=u**-2)
    return parameters(*fit.beta)


def by_tumble(folder, *flags):
    text = subprocess.run([TUMBLE, "certify", folder, "--json", *flags], capture_output=True, text=True).stdout
    run = json.loads(text)["runs"][0]["estimates"]
    names = ("bias", "misalignment", "scale_error")
    return [run[n]["value"] for n in names], [run[n]["standard_uncertainty"] for n in names]


def median_ms(call, times=31):
    call()
    out = []
    for _ in range(times):
        start = time.perf_counter()
        call()
        out.append((time.perf_counter() - start) * 1e3)
    return statistics.median(out)


def values_and_times(folder):
    subprocess.run(
        [TUMBLE, "simulate", folder, "--preset", "paper-3", "--angles", "-60:60:60", "--runs", "1", "--noise", "1.25LSB",
         "--scatter", "3arcmin", "--seed", "11"], check=True, capture_output=True)
    phi, y, u = read(folder)
    ours, uncertainty = by_tumble(folder, "--weights", "stated")
    rows = [
        ("tumble, likelihood", ours),
        ("tumble, exact", by_tumble(folder, "--method", "exact")[0]),
        ("statsmodels WLS", by_statsmodels(phi, y, u)),
        ("odrpack", by_odrpack(phi, y, u)),
    ]
    print(f"{'':22}{'bias, m/s²':>14}{'misalignment':>14}{'scale error':>14}   off, in standard uncertainties")
    for name, v in rows:
        off = [abs(a - b) / s for a, b, s in zip(v, ours, uncertainty)]
        print(f"{name:22}" + "".join(f"{x:14.7f}" for x in v) + "   " + " ".join(f"{o:.3f}" for o in off))
        assert max(off) < 0.25, (name, off)
    return median_ms(lambda: by_statsmodels(phi, y, u)), median_ms(lambda: by_odrpack(phi, y, u))


def plot(rows):
    fig, axes = plt.subplots(1, 2, figsize=(8, 3.2), sharey=True)
    for ax, varied, label in ((axes[0], "positions", "positions"), (axes[1], "samples", "samples a dwell")):
        for sigma, marker in ((1.25, "o"), (0.1, "s")):
            points = [(float(r["value"]), float(r["ms"])) for r in rows
                      if r["varied"] == varied and float(r["sigma_lsb"]) == sigma and float(r["value"]) < 5e4]
            x, ms = zip(*sorted(points))
            ax.loglog(x, ms, marker=marker, label=f"noise {sigma} LSB")
            if varied == "positions":
                slope = np.polyfit(np.log(x[2:]), np.log(ms[2:]), 1)[0]
                print(f"cost against positions from 60 on, noise {sigma} LSB: exponent {slope:.2f} (1 is linear)")
        ax.set_xlabel(label)
        ax.grid(True, which="both", alpha=0.3)
    axes[0].set_ylabel("time of a fit, ms")
    axes[0].legend()
    fig.tight_layout()
    matplotlib.rcParams["svg.hashsalt"] = "tumble"
    fig.savefig(ROOT / "docs/figures/cost.svg", metadata={"Date": None})


def main():
    with tempfile.TemporaryDirectory() as folder:
        statsmodels_ms, odrpack_ms = values_and_times(f"{folder}/bench")
    rows = list(csv.DictReader(subprocess.run([FIT_TIME], check=True, capture_output=True, text=True).stdout.splitlines()))
    noise = {r["value"]: float(r["ms"]) for r in rows if r["varied"] == "noise"}
    print(f"\nfit of 60 × 1500 codes after reading, ms: noise 1.25 LSB {noise['1.25']:.2f}, 0.1 LSB {noise['0.1']:.1f}")
    print(f"peers on the 60 averages, ms: statsmodels WLS (three solutions) {statsmodels_ms:.2f}, odrpack {odrpack_ms:.2f}")
    print(f"ratios at 1.25 LSB: statsmodels {statsmodels_ms / noise['1.25']:.1f}, odrpack {odrpack_ms / noise['1.25']:.1f}")
    longest = next(r for r in rows if r["value"] == "100000")
    print(f"100 000 positions of 20 codes: {float(longest['ms']):.0f} ms")
    plot(rows)


main()
