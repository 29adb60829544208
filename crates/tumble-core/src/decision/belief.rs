//! What is known of a value after it was measured, and the probability that it conforms.

use super::Limits;
use crate::stats::{normal_cdf, student_p_value};

/// The distribution that a probability of conformity was taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// Normal: the uncertainty is as good as known.
    Normal,
    /// Scaled and shifted Student: the uncertainty itself comes from few observations.
    Student,
}

impl Distribution {
    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Student => "student",
        }
    }
}

/// What is known of a value: an estimate with its standard uncertainty and degrees of freedom.
///
/// **Model** `(Y − y)/u` is Student's t with `ν` degrees of freedom, normal for infinite `ν`. No knowledge from before
/// the measurement goes in (JCGM 106, clauses 6 and 7; with degrees of freedom the Student distribution of JCGM 101).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Belief {
    /// `y`.
    pub value: f64,
    /// `u`; zero is a value known exactly.
    pub standard_uncertainty: f64,
    /// `ν`; infinite for a normal distribution.
    pub degrees_of_freedom: f64,
}

/// Probabilities that a value conforms and that it does not; they sum to 1, and each keeps its own digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConformityProbability {
    /// `p_c`: the producer's specific risk where the value is rejected.
    pub conforms: f64,
    /// `1 − p_c`: the consumer's specific risk where the value is accepted.
    pub fails: f64,
}

impl Belief {
    /// Which distribution stands for the value.
    #[must_use]
    pub fn distribution(&self) -> Distribution {
        if self.degrees_of_freedom.is_finite() {
            Distribution::Student
        } else {
            Distribution::Normal
        }
    }

    /// `P(Y > y + z u)`.
    #[must_use]
    pub fn upper_tail(&self, z: f64) -> f64 {
        let normal = || normal_cdf(-z);
        if !(self.degrees_of_freedom.is_finite() && z.is_finite()) {
            return normal();
        }
        let half = student_p_value(z, self.degrees_of_freedom).map(|p| 0.5 * p);
        half.map_or_else(normal, |half| if z >= 0.0 { half } else { 1.0 - half })
    }

    /// The probability of conformity with limits.
    ///
    /// **Model** `p_c = F((T_U − y)/u) − F((T_L − y)/u)`, JCGM 106 clause 7.
    ///
    /// ```
    /// use tumble_core::decision::{Belief, Limits};
    /// let belief = Belief { value: 10.0, standard_uncertainty: 0.8, degrees_of_freedom: f64::INFINITY };
    /// let limits = Limits::new(Some(9.0), Some(11.0)).unwrap();
    /// assert!((belief.conformity(limits).conforms - 0.78870).abs() < 5e-6);
    /// ```
    #[must_use]
    pub fn conformity(&self, limits: Limits) -> ConformityProbability {
        let (lower, upper) = limits.ends();
        if self.standard_uncertainty <= 0.0 {
            let conforms = if limits.contain(self.value) { 1.0 } else { 0.0 };
            return ConformityProbability { conforms, fails: 1.0 - conforms };
        }
        let below = (self.value - lower) / self.standard_uncertainty;
        let above = (upper - self.value) / self.standard_uncertainty;
        // Tails are taken on the side where they are small, so that neither probability is a difference of ones.
        let (conforms, fails) = if below < 0.0 {
            let conforms = self.upper_tail(-below) - self.upper_tail(above);
            (conforms, 1.0 - conforms)
        } else if above < 0.0 {
            let conforms = self.upper_tail(-above) - self.upper_tail(below);
            (conforms, 1.0 - conforms)
        } else {
            let fails = self.upper_tail(below) + self.upper_tail(above);
            (1.0 - fails, fails)
        };
        ConformityProbability { conforms: conforms.clamp(0.0, 1.0), fails: fails.clamp(0.0, 1.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(y, u, T_L, T_U, ν)` → `(p_c, 1 − p_c)` by scipy 1.17.1 (`norm`, `t`: cdf and sf).
    #[test]
    fn probabilities_of_scipy() {
        const INF: f64 = f64::INFINITY;
        for (y, u, lower, upper, dof, conforms, fails) in [
            (10.0, 0.8, 9.0, 11.0, INF, 0.788_700_452_666_289_3, 0.211_299_547_333_710_7),
            (10.5, 0.8, 9.0, 11.0, INF, 0.703_618_109_186_038_1, 0.296_381_890_813_961_93),
            (0.2, 0.05, -0.25, 0.25, 4.0, 0.812_627_600_591_17, 0.187_372_399_408_830_02),
            (0.2, 0.05, -0.25, 0.25, INF, 0.841_344_746_068_542_9, 0.158_655_253_931_457_07),
            (0.3, 0.05, -0.25, 0.25, 2.5, 0.200_273_353_215_886_43, 0.799_726_646_784_113_5),
            (0.1, 0.3, -INF, 0.25, 9.0, 0.685_464_350_086_986_8, 0.314_535_649_913_013_14),
            (0.24, 0.004, -0.25, 0.25, 57.0, 0.992_339_431_449_026_5, 0.007_660_568_550_973_55),
            (-1.2, 0.1, -1.0, 1.0, 1.0, 0.133_124_938_747_656_63, 0.866_875_061_252_343_5),
            (0.0, 0.1, -1.0, 1.0, 3.0, 0.997_871_600_941_585_8, 0.002_128_399_058_414_150_3),
            (5.0, 0.5, -1.0, 1.0, INF, 6.220_960_574_271_74e-16, 1.0),
        ] {
            let finite = |v: f64| v.is_finite().then_some(v);
            let limits = Limits::new(finite(lower), finite(upper)).unwrap();
            let belief = Belief { value: y, standard_uncertainty: u, degrees_of_freedom: dof };
            let p = belief.conformity(limits);
            // Relative: twelve digits of either probability, however small.
            assert!((p.conforms / conforms - 1.0).abs() < 1e-11, "{y} {u} {dof}: {p:?}");
            assert!((p.fails / fails - 1.0).abs() < 1e-11, "{y} {u} {dof}: {p:?}");
        }
    }

    #[test]
    fn a_value_known_exactly_conforms_or_does_not() {
        let limits = Limits::new(Some(-1.0), Some(1.0)).unwrap();
        let at = |value| {
            let exact =
                Belief { value, standard_uncertainty: 0.0, degrees_of_freedom: f64::INFINITY };
            exact.conformity(limits).conforms
        };
        assert_eq!((at(0.0), at(1.0), at(1.1)), (1.0, 1.0, 0.0));
    }
}
