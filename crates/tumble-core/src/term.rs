//! Test of one further term in the model of all runs together.

use crate::estimate::WeightedRow;
use crate::linalg::Triangular;
use crate::stats::{student_factor, student_p_value};

/// Share of a term's own sum of squares that the fitted columns must leave for it to be testable.
const TESTABLE_SHARE: f64 = 1e-9;

/// One further term common to several runs: its coefficient and whether it differs from zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TermTest {
    /// Coefficient, LSB per unit of the term's column.
    pub effect_lsb: f64,
    /// Its standard uncertainty.
    pub standard_uncertainty_lsb: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: f64,
    /// Two-sided p-value of "no effect".
    pub p_value: f64,
    /// Largest magnitude over the positions of what the term adds to the fitted model, LSB.
    pub peak_lsb: f64,
    /// Share of the column's own sum of squares that the others leave: one is independent of them, zero is one of them.
    pub share_left: f64,
    /// How much smaller Schwarz' criterion is with the term than without: `n ln(1 + t²/ν) − ln n`; positive favours it.
    pub bic_gain: f64,
}

impl TermTest {
    /// Half-width of the interval of the coefficient.
    #[must_use]
    pub fn expanded_lsb(&self, level: f64) -> Option<f64> {
        student_factor(level, self.degrees_of_freedom).map(|t| t * self.standard_uncertainty_lsb)
    }

    /// The smallest true effect that a test at 5 % would have found with a probability of 80 %.
    #[must_use]
    pub fn smallest_detectable_lsb(&self) -> Option<f64> {
        let size = student_factor(0.95, self.degrees_of_freedom)?;
        // One-sided 80 % is the two-sided factor of 60 %.
        let power = student_factor(0.60, self.degrees_of_freedom)?;
        Some((size + power) * self.standard_uncertainty_lsb)
    }
}

/// Tests whether the residuals of several runs share a multiple of a column.
///
/// Each run keeps its own bias, misalignment and scale (and further terms that were entered): the column is first freed of them (Frisch–Waugh), so the
/// coefficient is that of a joint fit. `columns[r][j]` belongs to `runs[r][j]`, in LSB per unit.
///
/// `None` where the plan cannot tell the term from the parameters, or no redundancy is left.
///
/// **Assumes** that the rows are over their standard deviations.
#[must_use]
pub fn test_term(runs: &[&[WeightedRow]], columns: &[Vec<f64>]) -> Option<TermTest> {
    let (mut zz, mut zr, mut rr, mut own) = (0.0, 0.0, 0.0, 0.0);
    let mut dof = -1.0;
    let mut bounds = 0.0;
    let mut equations = 0.0;
    let mut freed: Vec<f64> = Vec::new();
    for (rows, column) in runs.iter().zip(columns) {
        let further = WeightedRow::further_columns(rows);
        let full = |j: usize| -> Vec<f64> {
            rows[j].row.iter().chain(&rows[j].further[..further]).copied().collect()
        };
        let mut triangle = Triangular::new(3 + further);
        let weighted = |j: usize| column[j] / rows[j].sd_lsb;
        (0..rows.len()).for_each(|j| triangle.push(&full(j), weighted(j)));
        let Ok(b) = triangle.solve() else { continue };
        for (j, row) in rows.iter().enumerate() {
            let z = weighted(j) - full(j).iter().zip(&b).map(|(x, v)| x * v).sum::<f64>();
            zz += z * z;
            zr += z * row.residual;
            bounds += f64::from(u8::from(row.is_bound));
            rr += if row.is_bound { 0.0 } else { row.residual * row.residual };
            own += weighted(j) * weighted(j);
            freed.push(z * row.sd_lsb);
        }
        equations += rows.len() as f64;
        dof += rows.len() as f64 - 3.0 - further as f64;
    }
    if dof < 1.0 || zz <= TESTABLE_SHARE * own || zz <= 0.0 {
        return None;
    }
    let effect_lsb = zr / zz;
    // Rows are over their standard deviations: where some only bound their level, that is what they scatter by.
    let scale = if bounds > 0.0 {
        1.0f64.max((rr - zr * zr / zz) / (dof - bounds).max(1.0))
    } else {
        (rr - zr * zr / zz).max(0.0) / dof
    };
    let variance = scale / zz;
    let standard_uncertainty_lsb = variance.sqrt();
    let p_value = student_p_value(effect_lsb / standard_uncertainty_lsb, dof)?;
    let peak_lsb = freed.iter().map(|z| (effect_lsb * z).abs()).fold(0.0, f64::max);
    Some(TermTest {
        effect_lsb,
        standard_uncertainty_lsb,
        degrees_of_freedom: dof,
        p_value,
        peak_lsb,
        share_left: zz / own,
        bic_gain: bic_gain(effect_lsb / standard_uncertainty_lsb, dof, equations),
    })
}

/// Schwarz' criterion without a coefficient minus that with it, for its `t` with `ν` degrees of freedom.
///
/// **Model** `n ln(RSS₀/RSS₁) − ln n`, `RSS₀/RSS₁ = 1 + t²/ν`. BIC, not AICc: AICc favours a term from p = 0.16 on, which
/// says nothing beside a test at a fraction of a per cent; BIC asks for more the more positions there are.
fn bic_gain(t: f64, dof: f64, equations: f64) -> f64 {
    equations * (t * t / dof).ln_1p() - equations.ln()
}
