"""Writes distributions.csv: values of normal (and its tails), Student and F distributions by mpmath (40 digits).

Run with mpmath installed: python make_distributions.py > distributions.csv
"""
from mpmath import mp, mpf, erfc, exp, log, sqrt, betainc, erfinv

mp.dps = 60


def normal_cdf(z):
    return erfc(-z / sqrt(2)) / 2


def student_two_sided(t, nu):
    return betainc(nu / 2, mpf(1) / 2, 0, nu / (nu + t * t), regularized=True)


def student_factor(level, nu):
    p = 1 - level
    lo, hi = mpf(0), mpf(1)
    while student_two_sided(hi, nu) > p:
        hi *= 2
    for _ in range(200):
        mid = (lo + hi) / 2
        lo, hi = (mid, hi) if student_two_sided(mid, nu) > p else (lo, mid)
    return lo


def fisher(f, a, b):
    return betainc(b / 2, a / 2, 0, b / (b + a * f), regularized=True)


print("function,x,a,b,value")
row = lambda name, x, a, b, v: print(f"{name},{mp.nstr(x, 17)},{mp.nstr(a, 17)},{mp.nstr(b, 17)},{mp.nstr(v, 20)}")
for z in ["-37", "-20", "-8", "-5", "-3", "-1.959963984540054", "-1", "-0.25", "0", "0.5", "1", "2", "4", "8"]:
    row("normal_cdf", mpf(z), mpf(0), mpf(0), normal_cdf(mpf(float(z))))
for p in ["1e-12", "1e-6", "0.001", "0.025", "0.3", "0.5", "0.841", "0.975", "0.9999"]:
    row("normal_quantile", mpf(p), mpf(0), mpf(0), sqrt(2) * erfinv(2 * mpf(float(p)) - 1))
for nu in ["1", "2", "3", "4", "9.5", "17", "50", "57", "117", "1000", "100000", "9999999", "1e8"]:
    for level in ["0.68", "0.9", "0.95", "0.9545", "0.99", "0.999"]:
        row("student_factor", mpf(level), mpf(nu), mpf(0), student_factor(mpf(float(level)), mpf(nu)))
    for t in ["0.1", "1", "2.5", "6", "15"]:
        row("student_p_value", mpf(t), mpf(nu), mpf(0), student_two_sided(mpf(float(t)), mpf(nu)))
for a, b in [("1", "57"), ("2", "55"), ("3", "4"), ("10", "290")]:
    for f in ["0.2", "1", "4", "12"]:
        row("fisher_p_value", mpf(f), mpf(a), mpf(b), fisher(mpf(float(f)), mpf(a), mpf(b)))
for x in ["0", "0.1", "0.46875", "0.47", "1", "2.5", "4", "4.1", "12", "40", "1000"]:
    row("erfcx", mpf(x), mpf(0), mpf(0), exp(mpf(float(x)) ** 2) * erfc(mpf(float(x))))
# ln(Φ(b) − Φ(a)): the tails, where the difference of two cdfs has no digits left, and narrow intervals.
for a, b in [("-1", "1"), ("0.5", "0.75"), ("-0.001", "0.002"), ("-8", "-7.5"), ("6", "9"), ("35", "36"), ("-60", "-59"), ("-3", "40")]:
    a, b = mpf(float(a)), mpf(float(b))
    p = (erfc(a / sqrt(2)) - erfc(b / sqrt(2))) / 2 if a > 0 else (erfc(-b / sqrt(2)) - erfc(-a / sqrt(2))) / 2
    row("ln_normal_interval", mpf(0), a, b, log(p))
