//! Whether a position belongs to its run: what is left over of it, held against the others alone.

use crate::estimate::WeightedRow;
use crate::linalg::Triangular;
use crate::stats::student_p_value;

/// False alarms of the rule: of a hundred honest experiments one names a position.
pub const FALSE_ALARM: f64 = 0.01;
/// Unknowns of a run.
const UNKNOWNS: usize = 3;
/// Least degrees of freedom that the others keep.
const FEWEST_DOF: usize = 2;
/// Leverage from which a position carries an unknown by itself: nothing else says whether it belongs.
const ALONE: f64 = 1.0 - 1e-9;

/// What the other positions of a run say of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belonging {
    /// Read minus what the others expect, LSB.
    pub residual_lsb: f64,
    /// The same over its standard deviation, which the others give: externally studentized.
    pub studentized: f64,
    /// Its degrees of freedom, `n − p − 1`.
    pub degrees_of_freedom: f64,
    /// Share of the position in its own fitted value, 0 to 1.
    pub leverage: f64,
    /// Two-sided p-value of this position alone.
    pub p_value: f64,
}

/// Holds every position of a fitted run against the others.
///
/// The weights between positions are those of the fit, their common size comes from the others. `None` for dwells
/// whose codes only bound their level, and where the others are too few. `least_sd_lsb` is the least scatter that is
/// believed: data made by a formula have none.
///
/// **Model** with rows over their standard deviations `x_j`, what is left over `e_j`, leverage
/// `h_j = x_jᵀ(XᵀX)⁻¹x_j`: `t_j = e_j / (s_(j) √(1 − h_j))`, `s_(j)² = (Σe² − e_j²/(1 − h_j)) / (n − p − 1)`,
/// Student with `n − p − 1` degrees of freedom for Gaussian scatter whose shape is known. Read minus expected is
/// `e_j/(1 − h_j)`.
///
/// **Assumes** that the shape of the scatter is not itself fitted to the position; where it is, the rule names a
/// little less (measured in `tests/outliers.rs`).
///
/// **Source** R. D. Cook, S. Weisberg, *Residuals and Influence in Regression* (1982), 2.2.
#[must_use]
pub fn belonging(rows: &[WeightedRow], least_sd_lsb: f64) -> Vec<Option<Belonging>> {
    let mut triangle = Triangular::new(UNKNOWNS);
    rows.iter().for_each(|r| triangle.push(&r.row, r.y));
    let measured = rows.iter().filter(|r| !r.is_bound).count();
    let Ok(inverse) = triangle.unit_covariance() else { return vec![None; rows.len()] };
    if measured < UNKNOWNS + 1 + FEWEST_DOF {
        return vec![None; rows.len()];
    }
    let degrees_of_freedom = (measured - UNKNOWNS - 1) as f64;
    let squares: f64 = rows.iter().filter(|r| !r.is_bound).map(|r| r.residual.powi(2)).sum();
    let of = |r: &WeightedRow| {
        let leverage: f64 = (0..UNKNOWNS)
            .flat_map(|i| (0..UNKNOWNS).map(move |k| (i, k)))
            .map(|(i, k)| r.row[i] * inverse[(i, k)] * r.row[k])
            .sum();
        if r.is_bound || leverage >= ALONE {
            return None;
        }
        let deleted = r.residual / (1.0 - leverage);
        let others = (squares - r.residual * deleted).max(0.0) / degrees_of_freedom;
        let least = (least_sd_lsb / r.sd_lsb).powi(2);
        let studentized = deleted * ((1.0 - leverage) / others.max(least)).sqrt();
        Some(Belonging {
            residual_lsb: deleted * r.sd_lsb,
            studentized,
            degrees_of_freedom,
            leverage,
            p_value: student_p_value(studentized, degrees_of_freedom)?,
        })
    };
    rows.iter().map(of).collect()
}

/// The p-value of the farthest of `tests` positions: Bonferroni's bound, exact but for its square where it is small.
#[must_use]
pub fn of_farthest(p_value: f64, tests: usize) -> f64 {
    (p_value * tests as f64).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(y: &[f64]) -> Vec<WeightedRow> {
        let design = |i: usize| {
            let a = 0.2 * i as f64 - 1.0;
            [1.0, a.sin(), a.cos()]
        };
        let mut triangle = Triangular::new(3);
        y.iter().enumerate().for_each(|(i, v)| triangle.push(&design(i), *v));
        let b = triangle.solve().unwrap();
        y.iter()
            .enumerate()
            .map(|(i, v)| {
                let row = design(i);
                let fitted: f64 = row.iter().zip(&b).map(|(x, c)| x * c).sum();
                WeightedRow {
                    row,
                    y: *v,
                    sd_lsb: 1.0,
                    residual: v - fitted,
                    is_bound: false,
                    further: Default::default(),
                }
            })
            .collect()
    }

    /// `OLSInfluence.resid_studentized_external` and `hat_matrix_diag` of statsmodels 0.15.0 on the same numbers.
    #[test]
    fn residuals_are_those_of_statsmodels() {
        let y = [0.3, -0.1, 0.25, 0.4, -0.2, 1.9, 0.1, 0.05, -0.3, 0.2, 0.15];
        let found = belonging(&rows(&y), 0.0);
        for (i, (t, h)) in REFERENCE.iter().enumerate() {
            let b = found[i].unwrap();
            assert!(
                (b.studentized - t).abs() < 1e-9 && (b.leverage - h).abs() < 1e-9,
                "{i}: {b:?}"
            );
            assert_eq!(b.degrees_of_freedom, 7.0);
        }
    }

    #[test]
    fn what_others_expect_is_a_fit_without_it() {
        let y = [0.3, -0.1, 0.25, 0.4, -0.2, 1.9, 0.1, 0.05, -0.3, 0.2, 0.15];
        let all = rows(&y);
        let mut without = Triangular::new(3);
        all.iter()
            .enumerate()
            .filter(|(i, _)| *i != 5)
            .for_each(|(_, r)| without.push(&r.row, r.y));
        let b = without.solve().unwrap();
        let expected: f64 = all[5].row.iter().zip(&b).map(|(x, c)| x * c).sum();
        assert!((belonging(&all, 0.0)[5].unwrap().residual_lsb - (1.9 - expected)).abs() < 1e-12);
    }

    #[test]
    fn bounds_few_positions_and_formulas_are_left_in_peace() {
        let y = [0.3, -0.1, 0.25, 0.4, -0.2, 1.9, 0.1, 0.05, -0.3, 0.2, 0.15];
        let mut bounded = rows(&y);
        bounded[5].is_bound = true;
        assert_eq!(belonging(&bounded, 0.0)[5], None);
        assert!(belonging(&rows(&y[..5]), 0.0).iter().all(Option::is_none));
        // Rounding errors of a formula are no scatter.
        let exact: Vec<f64> = (0..11).map(|i| 3.0 + 1e-9 * f64::from(u8::from(i == 4))).collect();
        let found = belonging(&rows(&exact), 0.01);
        assert!(found[4].unwrap().p_value > 0.99, "{found:?}");
    }

    const REFERENCE: [(f64, f64); 11] = [
        (0.486152271209, 0.548758756106),
        (-0.554736869058, 0.284853088639),
        (-0.0995953512093, 0.18357086848),
        (0.0322166971402, 0.176003867784),
        (-1.10406559866, 0.200165479716),
        (6.99474040519, 0.213295878551),
        (-0.473451930161, 0.200165479716),
        (-0.434723491529, 0.176003867784),
        (-0.886920825043, 0.18357086848),
        (0.198516941873, 0.284853088639),
        (0.474259107903, 0.548758756106),
    ];
}
