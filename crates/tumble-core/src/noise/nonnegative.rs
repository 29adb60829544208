//! Least squares of few coefficients, none negative: the set that solves it is tried for.

/// Coefficients.
pub(super) const COUNT: usize = 5;

/// What a gradient may be by rounding, in parts of the largest product.
const ROUNDING: f64 = 1e-9;

/// A solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Least {
    /// `xᵀ G x − 2 bᵀ x`.
    pub value: f64,
    pub x: [f64; COUNT],
    /// Bits of the coefficients that are not zero.
    pub set: usize,
}

/// Least of `xᵀ G x − 2 bᵀ x` with no `x` negative and some of them zero; the diagonal of `G` is one.
///
/// **Model** Karush, Kuhn and Tucker: the solution of a set is the one looked for where no value is negative and no
/// coefficient outside would enter with a gain. There is one; sets are tried from `guess` on. Where rounding hides it, the
/// least of all sets serves.
pub(super) fn least(
    gram: &[[f64; COUNT]; COUNT],
    b: &[f64; COUNT],
    zero: [bool; COUNT],
    guess: usize,
) -> Least {
    let scale = b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
    let mut best = Least { value: f64::INFINITY, x: [0.0; COUNT], set: 0 };
    let holds = |set: usize, i: usize| set >> i & 1 == 1;
    for set in core::iter::once(guess).chain((0..1 << COUNT).filter(|s| *s != guess)) {
        if (0..COUNT).any(|i| zero[i] && holds(set, i)) {
            continue;
        }
        let (mut places, mut p) = ([0; COUNT], 0);
        for i in (0..COUNT).filter(|i| holds(set, *i)) {
            places[p] = i;
            p += 1;
        }
        let places = &places[..p];
        let Some(inverse) = inverse(gram, places) else { continue };
        let (mut x, mut value) = ([0.0; COUNT], 0.0);
        for (k, i) in places.iter().enumerate() {
            x[*i] = places.iter().enumerate().map(|(l, j)| inverse[k][l] * b[*j]).sum();
            value -= x[*i] * b[*i];
        }
        if x.iter().any(|x| *x < 0.0) {
            continue;
        }
        if value < best.value {
            best = Least { value, x, set };
        }
        let gains = |j: usize| {
            let slope: f64 = (0..COUNT).map(|k| gram[j][k] * x[k]).sum();
            b[j] - slope > ROUNDING * scale
        };
        if !(0..COUNT).any(|j| !holds(set, j) && !zero[j] && gains(j)) {
            return best_of(best, Least { value, x, set });
        }
    }
    best
}

fn best_of(a: Least, b: Least) -> Least {
    if b.value <= a.value { b } else { a }
}

/// Inverse of the products of some columns, by Gauss and Jordan; `None` where they cannot be told apart.
pub(super) fn inverse(
    gram: &[[f64; COUNT]; COUNT],
    places: &[usize],
) -> Option<[[f64; COUNT]; COUNT]> {
    /// Part of a column that the others must leave.
    const INDEPENDENT: f64 = 1e-12;
    let p = places.len();
    let mut a = [[0.0; COUNT]; COUNT];
    let mut out = [[0.0; COUNT]; COUNT];
    for k in 0..p {
        out[k][k] = 1.0;
        for l in 0..p {
            a[k][l] = gram[places[k]][places[l]];
        }
    }
    for k in 0..p {
        let pivot = a[k][k];
        if pivot <= INDEPENDENT || pivot.is_nan() {
            return None;
        }
        for l in 0..p {
            a[k][l] /= pivot;
            out[k][l] /= pivot;
        }
        for r in (0..p).filter(|r| *r != k) {
            let factor = a[r][k];
            for l in 0..p {
                a[r][l] -= factor * a[k][l];
                out[r][l] -= factor * out[k][l];
            }
        }
    }
    Some(out)
}
