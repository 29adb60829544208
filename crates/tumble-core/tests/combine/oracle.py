"""Answers of other programs for tests/combine/answers.rs, read by oracle.rs.

    python3 crates/tumble-core/tests/combine/oracle.py > crates/tumble-core/tests/combine/answers.rs

Univariate: statsmodels.stats.meta_analysis.combine_effects ("iterated": Paule-Mandel, "chi2": DerSimonian-Laird),
its Hartung-Knapp standard error; REML by direct maximization with scipy. Balanced: statsmodels MixedLM, REML.
Multivariate: REML over three variances by scipy (Nelder-Mead from many starts, then polished), numpy algebra.
"""
import sys
import numpy as np, scipy, statsmodels
from scipy import optimize, stats
from statsmodels.stats.meta_analysis import combine_effects
import statsmodels.regression.mixed_linear_model as mlm

print("//! Answers of other programs, printed by oracle.py.\n#![cfg_attr(rustfmt, rustfmt::skip)]\n#![allow(clippy::unreadable_literal, clippy::excessive_precision)] // Printed by a program.\n")
print("use super::oracle::{Mixed, Multivariate, Row, Univariate};\n")
print(f"// Python {sys.version.split()[0]}, numpy {np.__version__}, scipy {scipy.__version__}, statsmodels {statsmodels.__version__}")

SETS = {
    "unlike precision": ([0.61, -0.21, 0.95, 0.33, 0.72, 1.40, 0.18], [0.09, 0.01, 0.09, 0.01, 0.09, 0.09, 0.01]),
    "no spread": ([1.01, 0.99, 1.02, 1.00, 0.97], [0.0025, 0.0016, 0.0036, 0.0009, 0.0049]),
    "large spread": ([12.0, -3.5, 7.1, 0.4], [0.5, 1.2, 0.8, 0.3]),
    "three runs": ([0.0023, 0.0031, 0.0019], [1.6e-7, 4.0e-7, 9.0e-8]),
    "ten runs": ([0.5, 2.1, -0.7, 1.3, 0.9, 3.0, 0.2, 1.1, -1.5, 1.9], [1.0, 0.5, 2.0, 1.0, 0.7, 1.5, 0.9, 0.6, 1.1, 0.8]),
}

def reml1(y, v):
    def nll(w):
        W = 1 / (v + w); m = (W * y).sum() / W.sum()
        return 0.5 * (np.log(v + w).sum() + np.log(W.sum()) + (W * (y - m) ** 2).sum())
    top = 10 * (y.var() + v.max())
    grid = np.concatenate([[0], np.geomspace(top * 1e-8, top, 4000)])
    i = np.argmin([nll(w) for w in grid])
    if i == 0:
        return 0.0
    r = optimize.minimize_scalar(nll, bounds=(grid[i - 1], grid[min(i + 1, len(grid) - 1)]), method="bounded", options={"xatol": 1e-16})
    # The flat top is found to half the digits; the root of the slope to all.
    def slope(w):
        W = 1 / (v + w); m = (W * y).sum() / W.sum()
        return (W**2 * (y - m) ** 2).sum() - W.sum() + (W**2).sum() / W.sum()
    lo, hi = grid[max(i - 1, 0)], grid[i + 1]
    return optimize.brentq(slope, lo, hi, xtol=1e-18, rtol=1e-15)

def q_profile(y, v):
    def q(w):
        W = 1 / (v + w); m = (W * y).sum() / W.sum()
        return (W * (y - m) ** 2).sum()
    out = []
    for p in (0.975, 0.025):
        c = stats.chi2.ppf(p, len(y) - 1)
        out.append(0.0 if q(0) <= c else optimize.brentq(lambda w: q(w) - c, 0, 1e6 * (y.var() + v.max()), xtol=1e-18, rtol=1e-15))
    return out

print("pub const UNIVARIATE: &[Univariate] = &[")
for name, (y, v) in SETS.items():
    y, v = np.array(y), np.array(v)
    pm = combine_effects(y, v, method_re="iterated", use_t=True)
    dl = combine_effects(y, v, method_re="chi2", use_t=True)
    w = reml1(y, v)
    W = 1 / (v + w); m = (W * y).sum() / W.sum()
    hk = np.sqrt((W * (y - m) ** 2).sum() / (len(y) - 1) / W.sum())
    # combine_effects with the REML weights: its own Hartung-Knapp error.
    same = combine_effects(y, v + w, method_re="chi2", use_t=True)
    assert np.isclose(same.mean_effect_fe, m, rtol=1e-12) and np.isclose(same.sd_eff_w_fe_hksj, hk, rtol=1e-12)
    print(f'    // {name}\n    Univariate {{ values: &{list(map(float, y))}, variances: &{list(map(float, v))}, q: {pm.q:.12e}, p: {stats.chi2.sf(pm.q, len(y)-1):.12e}, '
          f'mandel_paule: {pm.tau2:.10e}, dersimonian_laird: {max(0, dl.tau2):.12e}, i_squared: {max(0, pm.i2):.12e}, reml: {w:.12e}, mean: {m:.12e}, '
          f'u: {hk:.12e}, interval: [{q_profile(y, v)[0]:.10e}, {q_profile(y, v)[1]:.10e}] }},')

print("];\n")

# Balanced, as a mixed model: 6 groups of 4; the group means with s2/4 are the units.
rng = np.random.default_rng(20)
g = np.repeat(np.arange(6), 4)
data = np.round(rng.normal(size=6)[g] * 1.5 + rng.normal(size=24), 3)
fit = mlm.MixedLM(data, np.ones((24, 1)), g).fit(reml=True, method="bfgs", gtol=1e-12)
means = data.reshape(6, 4).mean(1)
print(f"pub const MIXED: Mixed = Mixed {{ means: &{list(map(float, means))}, variance: {fit.scale/4:.12e}, omega2: {float(fit.cov_re[0][0]):.10e}, mean: {fit.fe_params[0]:.12e}, u: {fit.bse_fe[0]:.10e} }};\n")
print("pub const MULTIVARIATE: &[Multivariate] = &[")

# Multivariate: runs of unlike plans in two mountings, and a pair with the scale alone.
def case(seed, plans, mountings, pair, spread):
    rng = np.random.default_rng(seed)
    nm = len(set(mountings))
    P = 2 + nm
    units = []
    for plan, mount in zip(plans, mountings):
        phi = np.radians(np.linspace(*plan))
        A = np.column_stack([np.ones_like(phi), 9.81 * np.cos(phi), -9.81 * np.sin(phi)])
        C = np.linalg.inv(A.T @ A) * 0.0015**2
        C = np.array([[float(f"{c:.6e}") for c in row] for row in C])
        X = np.zeros((3, P)); X[0, 0] = 1; X[2, 1] = 1; X[1, 2 + mount] = 1
        y = np.array([0.0030, 0.002 + 0.01 * mount, 0.024]) + rng.normal(size=3) * np.array(spread) + rng.multivariate_normal(np.zeros(3), C)
        units.append(([0, 1, 2], np.array([float(f"{v:.9e}") for v in y]), C, X))
    if pair:
        X = np.zeros((1, P)); X[0, 1] = 1
        units.append(([2], np.array([float(f"{0.024 + rng.normal() * pair:.9e}")]), np.array([[pair**2]]), X))
    return units, P

def gls(units, P, om):
    A = np.zeros((P, P)); b = np.zeros(P); ld = 0.0
    for idx, y, C, X in units:
        V = C + np.diag(om[idx]); W = np.linalg.inv(V); ld += np.linalg.slogdet(V)[1]
        A += X.T @ W @ X; b += X.T @ W @ y
    M = np.linalg.inv(A); mu = M @ b
    mis = sum((y - X @ mu) @ np.linalg.inv(C + np.diag(om[idx])) @ (y - X @ mu) for idx, y, C, X in units)
    return mu, M, -0.5 * (ld + np.linalg.slogdet(A)[1] + mis)

def solve(units, P):
    size = np.array([np.mean([C[list(idx).index(j)][list(idx).index(j)] for idx, y, C, X in units if j in idx]) for j in range(3)])
    f = lambda x: -gls(units, P, x**2 * size)[2]
    best = min((optimize.minimize(f, s, method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 20000, "maxfev": 40000}) for s in
                ([0, 0, 0], [1, 1, 1], [3, .1, .1], [.1, 3, .1], [.1, .1, 3], [10, 10, 10])), key=lambda r: r.fun)
    for _ in range(3):
        best = optimize.minimize(f, best.x, method="Nelder-Mead", options={"xatol": 1e-13, "fatol": 1e-15, "maxiter": 20000, "maxfev": 40000})
    om = best.x**2 * size
    return np.where(om < 1e-8 * size, 0, om)

def hartung_knapp(units, P, om, mu, M, column, entry):
    n = sum(len(y) for _, y, _, _ in units)
    X = np.vstack([u[3] for u in units]); V = np.zeros((n, n)); y = np.concatenate([u[1] for u in units]); at = 0; blocks = []
    for idx, yy, C, _ in units:
        k = len(yy); V[at:at + k, at:at + k] = C + np.diag(om[idx]); blocks.append(slice(at, at + k)); at += k
    a = M[column] @ X.T @ np.linalg.inv(V)
    S = V - X @ M @ X.T
    has = [i for i, (idx, _, _, Xr) in enumerate(units) if entry in idx and Xr[list(idx).index(entry), column] != 0]
    K = np.array([[0.0] * n for _ in has])
    for r, i in enumerate(has):
        s = blocks[i]; K[r, s] = a[s] / np.sqrt(a[s] @ V[s, s] @ a[s])
    G = K @ S @ K.T; z = K @ (y - X @ mu)
    total = sum(a[s] @ V[s, s] @ a[s] for s in blocks)
    return np.sqrt(z @ z / np.trace(G) * total), np.trace(G) ** 2 / np.sum(G * G)

for name, args in {
    "unlike plans, two mountings": (3, [(-30, 29, 60)] * 2 + [(-65, 65, 60)] * 3, [0, 1, 0, 1, 0], None, (0.004, 2e-4, 1e-4)),
    "one mounting with a pair": (5, [(-30, 29, 60)] * 5, [0] * 5, 2e-5, (0.003, 0.0, 5e-5)),
    "three runs, one better": (11, [(-30, 29, 60), (-65, 65, 120), (-30, 29, 60)], [0] * 3, None, (0.0, 3e-4, 0.0)),
}.items():
    units, P = case(*args)
    om = solve(units, P)
    mu, M, ll = gls(units, P, om)
    entry = [0, 2] + [1] * (P - 2)
    hk = [hartung_knapp(units, P, om, mu, M, c, entry[c]) for c in range(P)]
    if P > 3:
        # Several columns of one entry, few units: from that entry alone.
        far = om.copy(); far[[0, 2]] = 1e8 * np.array([units[0][2][0, 0], units[0][2][2, 2]])
        mu2, M2, _ = gls(units, P, far)
        for c in range(2, P):
            hk[c] = hartung_knapp(units, P, far, mu2, M2, c, 1)
            mu[c] = mu2[c]
    print(f"    // {name}\n    Multivariate {{ units: &[")
    for (idx, y, C, X) in units:
        c = C.tolist()
        mount = int(np.argmax(X[1, 2:])) if len(idx) == 3 else 0
        if len(idx) == 3:
            print(f"        Row {{ values: [{', '.join(f'Some({v:.9e})' for v in y)}], c: [{', '.join(f'{c[i][j]:.6e}' for i, j in ((0,0),(0,1),(0,2),(1,1),(1,2),(2,2)))}], mounting: {mount} }},")
        else:
            print(f"        Row {{ values: [None, None, Some({y[0]:.9e})], c: [0.0, 0.0, 0.0, 0.0, 0.0, {c[0][0]:.6e}], mounting: 0 }},")
    print(f"    ], mountings: {P-2}, omega2: {[float(f'{o:.8e}') for o in om]}, log_likelihood: {ll:.10f}, mu: &{[float(f'{m:.10e}') for m in mu]}, "
          f"u: &{[float(f'{h[0]:.8e}') for h in hk]}, dof: &{[float(f'{h[1]:.8f}') for h in hk]} }},")
print("];")
