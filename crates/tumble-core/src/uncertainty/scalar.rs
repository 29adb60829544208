//! One formula for numbers and for numbers with their derivatives.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// What a measurement model computes with: `f64` in a Monte Carlo draw, [`Jet`] in the propagation.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// `f(x)` from the value of `x`: `f`, `f′`, `f″` there.
    #[must_use]
    fn map(self, f: impl FnOnce(f64) -> [f64; 3]) -> Self;
    /// Value.
    fn value(self) -> f64;

    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self {
        self.map(|x| {
            let r = x.sqrt();
            [r, 0.5 / r, -0.25 / (x * r)]
        })
    }

    /// Sine.
    #[must_use]
    fn sin(self) -> Self {
        self.map(|x| [x.sin(), x.cos(), -x.sin()])
    }

    /// Cosine.
    #[must_use]
    fn cos(self) -> Self {
        self.map(|x| [x.cos(), -x.sin(), -x.cos()])
    }

    /// Natural logarithm.
    #[must_use]
    fn ln(self) -> Self {
        self.map(|x| [x.ln(), 1.0 / x, -1.0 / (x * x)])
    }

    /// Exponential.
    #[must_use]
    fn exp(self) -> Self {
        self.map(|x| [x.exp(); 3])
    }

    /// `1/x`.
    #[must_use]
    fn reciprocal(self) -> Self {
        self.map(|x| [1.0 / x, -1.0 / (x * x), 2.0 / (x * x * x)])
    }

    /// Square.
    #[must_use]
    fn square(self) -> Self {
        self * self
    }
}

impl Scalar for f64 {
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn map(self, f: impl FnOnce(f64) -> [f64; 3]) -> Self {
        f(self)[0]
    }
    #[inline]
    fn value(self) -> f64 {
        self
    }
}

/// A number with its gradient and Hessian over `N` inputs: forward differentiation, exact to rounding.
///
/// ```
/// use tumble_core::uncertainty::{Jet, Scalar};
/// let [x, y] = Jet::inputs([3.0, 2.0]);
/// let f = x * x * y;
/// assert_eq!((f.value, f.gradient), (18.0, [12.0, 9.0]));
/// assert_eq!(f.hessian, [[4.0, 6.0], [6.0, 0.0]]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<const N: usize> {
    /// Value.
    pub value: f64,
    /// First derivatives.
    pub gradient: [f64; N],
    /// Second derivatives.
    pub hessian: [[f64; N]; N],
}

impl<const N: usize> Jet<N> {
    /// The inputs themselves.
    #[must_use]
    pub fn inputs(at: [f64; N]) -> [Self; N] {
        core::array::from_fn(|i| {
            let mut jet = Self::constant(at[i]);
            jet.gradient[i] = 1.0;
            jet
        })
    }

    /// `a·p + b·q` of derivatives, and `c (∇p ∇qᵀ + ∇q ∇pᵀ)` of second ones.
    fn combined(value: f64, (a, p): (f64, Self), (b, q): (f64, Self), c: f64) -> Self {
        let gradient = core::array::from_fn(|i| a * p.gradient[i] + b * q.gradient[i]);
        let hessian = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                a * p.hessian[i][j]
                    + b * q.hessian[i][j]
                    + c * (p.gradient[i] * q.gradient[j] + q.gradient[i] * p.gradient[j])
            })
        });
        Self { value, gradient, hessian }
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::combined(self.value + o.value, (1.0, self), (1.0, o), 0.0)
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::combined(self.value - o.value, (1.0, self), (-1.0, o), 0.0)
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::combined(self.value * o.value, (o.value, self), (self.value, o), 1.0)
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // Times the reciprocal.
    fn div(self, o: Self) -> Self {
        self * o.reciprocal()
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::combined(-self.value, (-1.0, self), (0.0, self), 0.0)
    }
}

impl<const N: usize> Scalar for Jet<N> {
    fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0; N], hessian: [[0.0; N]; N] }
    }

    fn map(self, f: impl FnOnce(f64) -> [f64; 3]) -> Self {
        let [value, first, second] = f(self.value);
        Self::combined(value, (first, self), (0.0, self), 0.5 * second)
    }

    fn value(self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula<T: Scalar>(x: [T; 3]) -> T {
        (x[0].sin() * x[1].exp() / x[2].sqrt() - x[2].ln() * x[0].cos()) * x[1].square()
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let at = [0.7, -0.4, 2.3];
        let jet = formula(Jet::inputs(at));
        let h = 1e-4;
        let moved = |i: usize, a: f64, j: usize, b: f64| {
            let mut x = at;
            x[i] += a;
            x[j] += b;
            formula(x)
        };
        for i in 0..3 {
            let first = (moved(i, h, i, 0.0) - moved(i, -h, i, 0.0)) / (2.0 * h);
            assert!((jet.gradient[i] - first).abs() < 1e-7);
            for j in 0..3 {
                let second = (moved(i, h, j, h) - moved(i, h, j, -h) - moved(i, -h, j, h)
                    + moved(i, -h, j, -h))
                    / (4.0 * h * h);
                assert!((jet.hessian[i][j] - second).abs() < 1e-6, "{i} {j}");
            }
        }
    }
}
