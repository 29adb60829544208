"""Draws docs/figures/coverage.svg from docs/figures/coverage.csv, which the long tier writes:

    TUMBLE_LONG=1 TUMBLE_STUDY=docs/figures cargo test -p tumble-core --test likelihood coverage
    python3 docs/figures/make_coverage.py        (needs matplotlib)

Each dot is the fraction of simulated runs whose interval held the truth, minus the level that the interval claims.
"""
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
MARKS = {"bias": "o", "misalignment": "s", "scale error": "^"}
COLOURS = {"bias": "#0072b2", "misalignment": "#d55e00", "scale error": "#009e73"}


def main():
    rows = list(csv.DictReader((HERE / "coverage.csv").open(encoding="utf-8")))
    scenarios = list(dict.fromkeys(r["scenario"] for r in rows))
    fig, axes = plt.subplots(1, 3, figsize=(9, 0.34 * len(scenarios) + 1.6), sharey=True)
    for ax, level in zip(axes, (68, 95, 99)):
        for k, (parameter, mark) in enumerate(MARKS.items()):
            own = [r for r in rows if r["parameter"] == parameter]
            y = [scenarios.index(r["scenario"]) + 0.22 * (k - 1) for r in own]
            x = [100 * float(r[f"{level} %"]) - level for r in own]
            ax.plot(x, y, mark, color=COLOURS[parameter], markersize=4, label=parameter)
        n = int(rows[0]["runs"])
        se = 100 * (level / 100 * (1 - level / 100) / n) ** 0.5
        ax.axvspan(-2 * se, 2 * se, color="#999999", alpha=0.35, linewidth=0)
        ax.axvline(0, color="black", linewidth=0.8)
        if level == 95:
            ax.axvspan(-0.5, 0.5, color="#999999", alpha=0.15, linewidth=0)
        ax.set_title(f"{level} % intervals", fontsize=9)
        ax.set_xlabel("actual − claimed, %", fontsize=8)
        ax.grid(axis="x", alpha=0.3)
        ax.tick_params(labelsize=8)
    axes[0].set_yticks(range(len(scenarios)), scenarios)
    handles, labels = axes[2].get_legend_handles_labels()
    fig.legend(handles, labels, fontsize=8, loc="lower center", ncol=3, frameon=False)
    axes[0].set_ylim(len(scenarios) - 0.5, -0.5)
    fig.tight_layout(rect=(0, 0.04, 1, 1))
    matplotlib.rcParams["svg.hashsalt"] = "tumble"
    fig.savefig(HERE / "coverage.svg", metadata={"Date": None})


main()
