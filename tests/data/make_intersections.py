"""How often five 95 % intervals (Student, 57 degrees of freedom) have nothing in common, spread = one standard error.

    python3 tests/data/make_intersections.py

Prints the fractions that `crates/tumble-core/tests/statistics.rs` expects: truth inside all five, and empty.
"""
import numpy as np

T57 = 2.0024654592910065  # two-sided 95 %, mpmath
rng = np.random.default_rng(1)
n = 1_000_000
values = rng.standard_normal((n, 5)) + rng.standard_normal((n, 5))
half = T57 * np.sqrt(rng.chisquare(57, (n, 5)) / 57)
low, high = (values - half).max(axis=1), (values + half).min(axis=1)
print(f"inside all five {np.mean((low <= 0) & (0 <= high)):.4f}, empty {np.mean(low > high):.4f}")
