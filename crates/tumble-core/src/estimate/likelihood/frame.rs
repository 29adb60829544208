//! The model about a reference solution: rows, levels, steepness, and what is known about the scatter beforehand.

use crate::Position;
use crate::estimate::Setting;

/// `m_j(θ) = origin_j + row_j · (θ − reference)` for every position, `θ = (α, β, γ)`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    /// `(α, β, γ)`, LSB.
    pub reference: [f64; 3],
    /// `(1, sinφ, cosφ)`; upright `(1, ±β/R, ±γ/R)`: `√(β²+γ²)` is homogeneous of degree one.
    pub rows: Vec<[f64; 3]>,
    /// Levels at the reference, upright ones with what leaning costs on average.
    pub origins: Vec<f64>,
    /// `(∂m/∂φ)²`, LSB² per rad²; zero upright, on the table at least [`LEAST_STEEPNESS`].
    pub steepness: Vec<f64>,
    /// Variance that is not estimated: lean of upright dwells `R² u(δ)⁴/2`, and a stated angle uncertainty.
    pub known_variances: Vec<f64>,
}

/// Steepness, over `R = g/k*`, below which an angle error counts no less: `cos 70°`. Toward the vertical the scatter of
/// the angles vanishes only on paper; tilt of the axis and lean of the sensor do not, and dwells there must not outweigh
/// all others by belief alone.
const LEAST_STEEPNESS: f64 = 0.342;

impl Frame {
    /// About a reference; `angle_rad` is a standard deviation of the angles that is taken as known.
    pub fn about(
        reference: [f64; 3],
        positions: &[&Position],
        setting: &Setting<'_>,
        angle_rad: f64,
    ) -> Self {
        let [alpha, beta, gamma] = reference;
        let r = beta.hypot(gamma);
        let u_lean = setting.bench.vertical_lean.rad();
        let n = positions.len();
        let mut out = Self {
            reference,
            rows: Vec::with_capacity(n),
            origins: Vec::with_capacity(n),
            steepness: Vec::with_capacity(n),
            known_variances: Vec::with_capacity(n),
        };
        for p in positions {
            let (row, steepness, known, lean) = match p.seat.vertical_sign() {
                None => {
                    let (sin, cos) = p.angle.rad().sin_cos();
                    let steepness =
                        (beta * cos - gamma * sin).powi(2).max((LEAST_STEEPNESS * r).powi(2));
                    ([1.0, sin, cos], steepness, steepness * angle_rad * angle_rad, 0.0)
                }
                Some(sign) => (
                    [1.0, sign * beta / r, sign * gamma / r],
                    0.0,
                    r * r * u_lean.powi(4) / 2.0,
                    -sign * r * u_lean * u_lean / 2.0,
                ),
            };
            out.origins.push(alpha + beta * row[1] + gamma * row[2] + lean);
            out.rows.push(row);
            out.steepness.push(steepness);
            out.known_variances.push(known);
        }
        out
    }
}
