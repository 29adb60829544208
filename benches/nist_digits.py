"""Correct digits on NIST's linear sets: ours beside statsmodels' and, where Rscript is installed, R's.

    python3 -m venv .tools/bench && .tools/bench/bin/pip install numpy statsmodels
    .tools/bench/bin/python benches/nist_digits.py ../shared/data/nist_strd

Fewest correct digits of a coefficient (at most 15). Ours are those that the test `nist_strd` prints.
"""
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import statsmodels.api as sm

SETS = ["Norris", "Pontius", "NoInt1", "NoInt2", "Longley", "Filip", "Wampler1", "Wampler2", "Wampler3", "Wampler4", "Wampler5"]
ROOT = pathlib.Path(__file__).resolve().parent.parent


def read(file):
    text = file.read_text(encoding="latin-1")
    certified = [float(m.group(1)) for m in re.finditer(r"^\s+B\d+\s+(\S+)\s+\S+\s*$", text, re.M)]
    first = int(re.search(r"Data\s+\(lines\s+(\d+)", text).group(1))
    data = [[float(w) for w in line.split()] for line in text.splitlines()[first - 1:] if line.strip()]
    return np.array(certified), np.array(data)


def design(name, x, p):
    if name.startswith("NoInt"):
        return x
    if name == "Longley":
        return np.column_stack([np.ones(len(x)), x])
    return np.column_stack([x[:, 0] ** k for k in range(p)])


def digits(ours, certified):
    error = np.abs(np.where(certified == 0, ours, (ours - certified) / np.where(certified == 0, 1, certified)))
    return float(np.min(np.where(error == 0, 15, np.minimum(15, -np.log10(np.maximum(error, 1e-300))))))


def by_r(x, y):
    if not shutil.which("Rscript"):
        return None
    rows = "\n".join(",".join(f"{v:.17g}" for v in [b, *a]) for a, b in zip(x, y))
    code = 'd <- as.matrix(read.csv(file("stdin"), header=FALSE)); cat(sprintf("%.17g", lm.fit(d[,-1,drop=FALSE], d[,1], tol=1e-14)$coefficients))'
    out = subprocess.run(["Rscript", "-e", code], input=rows, capture_output=True, text=True, check=True).stdout.split()
    return np.array([np.nan if v == "NA" else float(v) for v in out])


def ours():
    out = subprocess.run(["cargo", "test", "-q", "-p", "tumble-core", "--test", "nist_strd", "--", "--nocapture"],
                         cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return dict(re.findall(r"^(\w+)\s+estimates\s+([\d.]+) digits", out, re.M))


def main():
    mine = ours()
    print(f"{'':10}{'tumble':>8}{'statsmodels qr':>16}{'statsmodels pinv':>18}{'R lm.fit':>10}")
    for name in SETS:
        certified, data = read(pathlib.Path(sys.argv[1]) / f"{name}.dat")
        x, y = design(name, data[:, 1:], len(certified)), data[:, 0]
        qr = digits(sm.OLS(y, x).fit(method="qr").params, certified)
        pinv = digits(sm.OLS(y, x).fit(method="pinv").params, certified)
        r = by_r(x, y)
        shown = "absent" if r is None else ("gives up" if np.isnan(r).any() else f"{digits(r, certified):.1f}")
        print(f"{name:10}{mine[name]:>8}{qr:16.1f}{pinv:18.1f}{shown:>10}")


main()
