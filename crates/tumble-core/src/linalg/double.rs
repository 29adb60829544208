//! Numbers with twice the digits of `f64`, as an unevaluated sum of two.
//!
//! Least squares loses digits with the square of the condition number where residuals are large. Rotations in
//! double-double leave rounding behind: what is lost then is only what the data themselves do not hold.
//!
//! **Source** T. J. Dekker, *A floating-point technique for extending the available precision*, Numer. Math. 18
//! (1971); D. E. Knuth, TAOCP 2, 4.2.2.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo`, with `|lo|` at most half a unit in the last place of `hi`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Double {
    pub(super) hi: f64,
    pub(super) lo: f64,
}

/// Sum and its rounding error.
#[inline]
fn two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    let b_part = hi - a;
    Double { hi, lo: (a - (hi - b_part)) + (b - b_part) }
}

/// The same where `|a| ≥ |b|`.
#[inline]
fn quick_two_sum(a: f64, b: f64) -> Double {
    let hi = a + b;
    Double { hi, lo: b - (hi - a) }
}

/// Upper and lower half of the digits. Beyond 1e290 the splitting overflows; measurements are far below.
#[inline]
fn split(a: f64) -> (f64, f64) {
    const HALF: f64 = 134_217_729.0; // 2^27 + 1
    let t = HALF * a;
    let hi = t - (t - a);
    (hi, a - hi)
}

/// Product and its rounding error. `f64::mul_add` would be a library call on baseline x86-64.
#[inline]
fn two_product(a: f64, b: f64) -> Double {
    let hi = a * b;
    let ((a1, a0), (b1, b0)) = (split(a), split(b));
    Double { hi, lo: ((a1 * b1 - hi) + a1 * b0 + a0 * b1) + a0 * b0 }
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        let (s, t) = (two_sum(self.hi, o.hi), two_sum(self.lo, o.lo));
        let v = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(v.hi, v.lo + t.lo)
    }
}

impl Neg for Double {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Double {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Double {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let p = two_product(self.hi, o.hi);
        quick_two_sum(p.hi, p.lo + (self.hi * o.lo + self.lo * o.hi))
    }
}

impl Div for Double {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        let first = self.hi / o.hi;
        let rest = self - o * first.into();
        let second = rest.hi / o.hi;
        let rest = rest - o * second.into();
        quick_two_sum(first, second) + (rest.hi / o.hi).into()
    }
}

impl Double {
    /// Square root by one Newton step from `f64`.
    #[inline]
    pub(super) fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::default();
        }
        let root = self.hi.sqrt();
        let rest = self - two_product(root, root);
        quick_two_sum(root, rest.hi / (2.0 * root))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_digits() {
        let third = Double::from(1.0) / 3.0.into();
        let rest = Double::from(1.0) - third * 3.0.into();
        assert!(rest.hi.abs() < 1e-31, "{rest:?}");
        let two = Double::from(2.0).sqrt() * Double::from(2.0).sqrt();
        assert!((two - 2.0.into()).hi.abs() < 1e-30);
        // What f64 cancels to zero is kept.
        let small = (Double::from(1e16) + 1.0.into()) - 1e16.into();
        assert_eq!((small.hi, small.lo), (1.0, 0.0));
        assert_eq!(Double::from(0.0).sqrt(), Double::default());
    }
}
