//! Names, units and distributions of what a budget is made of.

use crate::stats::normal_cdf;

/// One input quantity of the budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// `g`: used value.
    Gravity,
    /// `ε`: the true angle is `φ (1 + ε)`.
    DialScale,
    /// `e_s`: the true angle is `φ + e_s sin φ`.
    EccentricitySine,
    /// `e_c`: the true angle is `φ + e_c (cos φ − 1)`; what it is at zero lies in the misalignment.
    EccentricityCosine,
    /// Zero of the dial and level of the table together.
    DialZero,
    /// `ψη`: the reading gains `g ψ η`.
    TiltTimesLean,
    /// `(ψ² + η²)/2`: the reading loses that share of `g sin(φ+Δφ)`.
    TiltAndLeanCosine,
    /// A bow of the converter, LSB at its peak.
    ConverterBow,
    /// An S of the converter, LSB at its peak.
    ConverterS,
    /// The converter's reference, used over calibrated.
    Reference,
    /// Rounding that repeats share.
    Resolution,
    /// K2.
    Quadratic,
    /// K3.
    Cubic,
    /// Bias per kelvin.
    BiasTempco,
    /// Scale per kelvin.
    ScaleTempco,
}

impl Quantity {
    /// All, in the order of every list.
    pub const ALL: [Self; 15] = [
        Self::Gravity,
        Self::DialScale,
        Self::EccentricitySine,
        Self::EccentricityCosine,
        Self::DialZero,
        Self::TiltTimesLean,
        Self::TiltAndLeanCosine,
        Self::ConverterBow,
        Self::ConverterS,
        Self::Reference,
        Self::Resolution,
        Self::Quadratic,
        Self::Cubic,
        Self::BiasTempco,
        Self::ScaleTempco,
    ];

    /// Name in the budget.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Gravity => "local gravity",
            Self::DialScale => "scale of the dial",
            Self::EccentricitySine => "eccentricity of the dial, sine",
            Self::EccentricityCosine => "eccentricity of the dial, cosine",
            Self::DialZero => "zero of the dial",
            Self::TiltTimesLean => "axis tilt times sensor lean",
            Self::TiltAndLeanCosine => "axis tilt and sensor lean, cosine",
            Self::ConverterBow => "converter nonlinearity, bow",
            Self::ConverterS => "converter nonlinearity, S",
            Self::Reference => "converter reference",
            Self::Resolution => "resolution",
            Self::Quadratic => "K2",
            Self::Cubic => "K3",
            Self::BiasTempco => "temperature on bias",
            Self::ScaleTempco => "temperature on scale",
        }
    }

    /// Unit of its standard uncertainty.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Gravity => "m/s2",
            Self::EccentricitySine | Self::EccentricityCosine | Self::DialZero => "rad",
            Self::TiltTimesLean | Self::TiltAndLeanCosine => "rad2",
            Self::ConverterBow | Self::ConverterS | Self::Resolution => "LSB",
            Self::DialScale | Self::Reference => "1",
            Self::Quadratic => "1/(m/s2)",
            Self::Cubic => "1/(m/s2)2",
            Self::BiasTempco => "m/s2/K",
            Self::ScaleTempco => "1/K",
        }
    }
}

/// How a quantity is distributed about zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Gaussian.
    Normal,
    /// Any value within ±√3 standard uncertainties is as likely.
    Rectangular,
    /// The product of two independent Gaussian angles of zero mean, rad.
    Product {
        /// Standard uncertainties of the two.
        u_rad: [f64; 2],
    },
    /// Half the sum of the squares of the **same** two angles: never negative, and not zero on average. Its standard
    /// uncertainty is the root mean square about zero, for no correction is made for it.
    HalfSquares {
        /// Standard uncertainties of the two.
        u_rad: [f64; 2],
    },
}

impl Shape {
    /// Name in the budget.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Rectangular => "rectangular",
            Self::Product { .. } => "product of normals",
            Self::HalfSquares { .. } => "squares of normals",
        }
    }

    /// A draw with a given standard uncertainty from independent standard Gaussian numbers.
    ///
    /// [`Self::Product`] and [`Self::HalfSquares`] of one bench share both numbers; the others use the first.
    ///
    /// ```
    /// use tumble_core::systematic::Shape;
    /// assert_eq!(Shape::Normal.draw(2.0, [1.5, 0.0]), 3.0);
    /// assert!(Shape::Rectangular.draw(1.0, [9.0, 0.0]) <= 3f64.sqrt());
    /// assert_eq!(Shape::Product { u_rad: [0.1, 0.2] }.draw(0.02, [1.0, -1.0]), -0.1 * 0.2);
    /// ```
    #[must_use]
    pub fn draw(self, standard_uncertainty: f64, normal: [f64; 2]) -> f64 {
        match self {
            Self::Normal => standard_uncertainty * normal[0],
            Self::Rectangular => {
                standard_uncertainty * 3f64.sqrt() * (2.0 * normal_cdf(normal[0]) - 1.0)
            }
            Self::Product { u_rad } => u_rad[0] * normal[0] * u_rad[1] * normal[1],
            Self::HalfSquares { u_rad } => {
                ((u_rad[0] * normal[0]).powi(2) + (u_rad[1] * normal[1]).powi(2)) / 2.0
            }
        }
    }

    /// Standard uncertainty that follows from the shape's own angles; `None` for shapes without.
    ///
    /// **Model** `u(ψη) = u_ψ u_η`; `E[((ψ²+η²)/2)²] = (3 u_ψ⁴ + 3 u_η⁴ + 2 u_ψ² u_η²)/4`.
    #[must_use]
    pub fn own_uncertainty(self) -> Option<f64> {
        match self {
            Self::Normal | Self::Rectangular => None,
            Self::Product { u_rad: [a, b] } => Some(a * b),
            Self::HalfSquares { u_rad: [a, b] } => {
                let fourth = 3.0 * (a.powi(4) + b.powi(4)) + 2.0 * (a * b).powi(2);
                Some(fourth.sqrt() / 2.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::normal_quantile;

    #[test]
    fn draws_have_the_uncertainty_that_they_are_said_to_have() {
        let u_rad = [0.01, 0.02];
        let shapes = [
            Shape::Normal,
            Shape::Rectangular,
            Shape::Product { u_rad },
            Shape::HalfSquares { u_rad },
        ];
        for shape in shapes {
            let u = shape.own_uncertainty().unwrap_or(0.5);
            // A grid in probability stands for independent draws.
            let n = 400;
            let z = |i: u32| normal_quantile((f64::from(i) + 0.5) / f64::from(n));
            let squares: f64 = (0..n)
                .flat_map(|i| (0..n).map(move |j| (i, j)))
                .map(|(i, j)| shape.draw(u, [z(i), z(j)]).powi(2))
                .sum();
            let rms = (squares / f64::from(n * n)).sqrt();
            assert!((rms / u - 1.0).abs() < 0.02, "{}: {rms} for {u}", shape.name());
        }
    }

    #[test]
    fn names_are_unique() {
        for (i, a) in Quantity::ALL.iter().enumerate() {
            assert_eq!(*a as usize, i);
            assert!(Quantity::ALL[..i].iter().all(|b| a.name() != b.name()));
        }
    }
}
