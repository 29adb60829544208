//! Decision rules: what is accepted, and what the rule risks at worst.

use super::{Belief, Limits};

/// Width of a guard band in multiples of the expanded uncertainty `U`: `w = r U`.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct GuardMultiple(f64);

impl GuardMultiple {
    /// ISO 14253-1: at most 5 % of one-sided decisions at the acceptance limit are wrong (4.85 % with `U = 2u`).
    pub const ISO_14253_1: Self = Self(0.83);
    /// ILAC-G8, the usual guard band: at most 2.5 % (2.28 % with `U = 2u`).
    pub const ONE_U: Self = Self(1.0);
    /// Three standard uncertainties: at most 0.16 % (0.135 % with `U = 2u`).
    pub const ONE_AND_A_HALF_U: Self = Self(1.5);
    /// Six standard uncertainties: less than 1 ppm (1e-9 with `U = 2u`).
    pub const THREE_U: Self = Self(3.0);
    /// The largest that is taken for meant: ILAC-G8 names none above 3.
    pub const LARGEST: f64 = 10.0;

    /// A multiple; `None` unless it is above zero and at most [`Self::LARGEST`]. Zero is [`Rule::Simple`].
    #[must_use]
    pub fn new(multiple: f64) -> Option<Self> {
        (multiple > 0.0 && multiple <= Self::LARGEST).then_some(Self(multiple))
    }

    /// `r`.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A rule that turns a value with its uncertainty into a decision.
///
/// **Source** ILAC-G8:09/2019: binary statements with simple acceptance, with a guard band, and non-binary statements; JCGM 106 clause 8.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// Accepted where the value keeps the limits: `w = 0`, the risk is shared.
    Simple,
    /// Accepted where the value keeps the limits by a guard band.
    Guarded(GuardMultiple),
    /// Four answers: inside of the limits by the guard band, inside, outside, outside by the guard band.
    NonBinary(GuardMultiple),
}

impl Default for Rule {
    /// Guarded acceptance with `w = U`: where nobody chose a rule, the consumer is protected.
    fn default() -> Self {
        Self::Guarded(GuardMultiple::ONE_U)
    }
}

/// What was decided, from best to worst: of several statuses the greatest stands for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Accepted.
    Pass,
    /// Inside of the limits, but by less than the guard band.
    ConditionalPass,
    /// No limits, no value, or a rule that could accept nothing.
    NotAssessed,
    /// Outside of the limits, but by less than the guard band.
    ConditionalFail,
    /// Rejected.
    Fail,
}

impl Status {
    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::ConditionalPass => "conditional_pass",
            Self::NotAssessed => "not_assessed",
            Self::ConditionalFail => "conditional_fail",
            Self::Fail => "fail",
        }
    }

    /// Whether the value was accepted, with or without condition; `None` where nothing was decided.
    #[must_use]
    pub fn accepted(self) -> Option<bool> {
        match self {
            Self::Pass | Self::ConditionalPass => Some(true),
            Self::NotAssessed => None,
            Self::ConditionalFail | Self::Fail => Some(false),
        }
    }
}

/// The largest specific risks that a rule allows for given limits and uncertainty, wherever the value lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorstCase {
    /// Consumer's: largest probability that a passed value does not conform; `None` where nothing can pass.
    pub consumer: Option<f64>,
    /// Producer's: largest probability that a failed value conforms after all.
    pub producer: f64,
    /// Largest probability that a conditional answer is wrong; `None` where there is no such answer.
    pub conditional: Option<f64>,
}

impl Rule {
    /// Name in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Guarded(_) => "guarded",
            Self::NonBinary(_) => "non-binary",
        }
    }

    /// `r` of the guard band `w = r U`; zero for simple acceptance.
    #[must_use]
    pub fn guard_multiple(self) -> f64 {
        match self {
            Self::Simple => 0.0,
            Self::Guarded(r) | Self::NonBinary(r) => r.get(),
        }
    }

    /// The acceptance limits `A = T ∓ w`; `None` where the guard bands leave nothing between them.
    #[must_use]
    pub fn acceptance(self, limits: Limits, expanded_uncertainty: f64) -> Option<Limits> {
        limits.moved_inward(self.guard_multiple() * expanded_uncertainty)
    }

    /// The decision on a value.
    ///
    /// A guarded rule whose bands leave no room rejects what is out of the limits and decides nothing about the rest: to
    /// fail a value there would say something about the measurement, not about the unit.
    #[must_use]
    pub fn decide(self, limits: Limits, value: f64, expanded_uncertainty: f64) -> Status {
        let inside = limits.contain(value);
        let accepted =
            self.acceptance(limits, expanded_uncertainty).map(|a| inside && a.contain(value));
        match (self, inside, accepted) {
            (_, true, Some(true)) => Status::Pass,
            (Self::Guarded(_), true, None) => Status::NotAssessed,
            (Self::NonBinary(_), true, _) => Status::ConditionalPass,
            (Self::NonBinary(r), false, _) => {
                let far = limits.moved_inward(-r.get() * expanded_uncertainty);
                if far.is_some_and(|far| far.contain(value)) {
                    Status::ConditionalFail
                } else {
                    Status::Fail
                }
            }
            (Self::Simple | Self::Guarded(_), ..) => Status::Fail,
        }
    }

    /// The largest specific risks of the rule for a value of unknown size with the uncertainty of `belief`.
    ///
    /// The probability of conformity falls from the middle of the limits outward, so the worst case of an accepted value
    /// lies at an acceptance limit, that of a rejected one just beyond it.
    ///
    /// ```
    /// use tumble_core::decision::{Belief, GuardMultiple, Limits, Rule};
    /// let belief = Belief { value: 0.0, standard_uncertainty: 1.0, degrees_of_freedom: f64::INFINITY };
    /// let at_most = Limits::new(None, Some(100.0)).unwrap();
    /// let rule = Rule::Guarded(GuardMultiple::ISO_14253_1);
    /// let worst = rule.worst_case(at_most, &belief, 2.0);
    /// assert!((worst.consumer.unwrap() - 0.0485).abs() < 5e-5);
    /// ```
    #[must_use]
    pub fn worst_case(
        self,
        limits: Limits,
        belief: &Belief,
        expanded_uncertainty: f64,
    ) -> WorstCase {
        let w = self.guard_multiple() * expanded_uncertainty;
        let at = |value: f64| Belief { value, ..*belief }.conformity(limits);
        let over = |ends: Limits, of: &dyn Fn(f64) -> f64| {
            ends.lower().into_iter().chain(ends.upper()).map(of).fold(0.0, f64::max)
        };
        let fails = |v: f64| at(v).fails;
        let conforms = |v: f64| at(v).conforms;
        let acceptance = self.acceptance(limits, expanded_uncertainty);
        let consumer = acceptance.map(|a| over(a, &fails));
        if belief.standard_uncertainty <= 0.0 {
            // What is known exactly is decided rightly, at a limit and just beyond it.
            let conditional = matches!(self, Self::NonBinary(_)).then_some(0.0);
            return WorstCase { consumer, producer: 0.0, conditional };
        }
        match self {
            Self::Simple => {
                WorstCase { consumer, producer: over(limits, &conforms), conditional: None }
            }
            Self::Guarded(_) => {
                // Without an acceptance zone only what is out of the limits is rejected.
                let producer = over(acceptance.unwrap_or(limits), &conforms);
                WorstCase { consumer, producer, conditional: None }
            }
            Self::NonBinary(_) => WorstCase {
                consumer,
                producer: limits.moved_inward(-w).map_or(0.0, |far| over(far, &conforms)),
                conditional: Some(over(limits, &fails).max(over(limits, &conforms))),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Belief =
        Belief { value: 0.0, standard_uncertainty: 1.0, degrees_of_freedom: f64::INFINITY };

    /// ILAC-G8:09/2019, table of guard bands, one-sided, `U = 2u`; digits by scipy 1.17.1 `norm.sf(2 r)`.
    #[test]
    fn worst_cases_of_ilac_g8() {
        let at_most = Limits::new(None, Some(50.0)).unwrap();
        for (r, printed, half_digit, below, scipy) in [
            (GuardMultiple::ISO_14253_1, 0.0485, 5e-5, 0.05, 0.048_457_226_266_722_82),
            (GuardMultiple::ONE_U, 0.0228, 5e-5, 0.025, 0.022_750_131_948_179_195),
            (GuardMultiple::ONE_AND_A_HALF_U, 0.00135, 5e-6, 0.0016, 0.001_349_898_031_630_093_3),
            (GuardMultiple::THREE_U, 1e-9, 5e-10, 1e-6, 9.865_876_450_376_946e-10),
        ] {
            for rule in [Rule::Guarded(r), Rule::NonBinary(r)] {
                let risk = rule.worst_case(at_most, &UNIT, 2.0).consumer.unwrap();
                assert!((risk / scipy - 1.0).abs() < 1e-11, "{r:?}: {risk:e}");
                assert!((risk - printed).abs() < half_digit, "{r:?}: {risk:e}");
                assert!(risk < below);
            }
        }
        let simple = Rule::Simple.worst_case(at_most, &UNIT, 2.0);
        assert_eq!((simple.consumer, simple.producer), (Some(0.5), 0.5));
    }

    /// With Student's coverage factor the guard band of one `U` risks half of what the level leaves, for any number of
    /// degrees of freedom.
    #[test]
    fn few_degrees_of_freedom_do_not_change_the_risk_of_one_u() {
        let at_most = Limits::new(None, Some(50.0)).unwrap();
        for dof in [1.0, 2.0, 4.3, 57.0, 1e6, f64::INFINITY] {
            let u = crate::stats::student_factor(0.95, dof).unwrap();
            let belief = Belief { degrees_of_freedom: dof, ..UNIT };
            let risk = Rule::default().worst_case(at_most, &belief, u).consumer.unwrap();
            // Quantile and tail of the normal distribution agree to ten digits.
            assert!((risk - 0.025).abs() < 1e-9, "{dof}: {risk}");
        }
    }

    #[test]
    fn zones() {
        let limits = Limits::new(Some(-1.0), Some(1.0)).unwrap();
        let r = GuardMultiple::ONE_U;
        use Status::{ConditionalFail, ConditionalPass, Fail, Pass};
        for (value, simple, guarded, four) in [
            (0.0, Pass, Pass, Pass),
            (0.75, Pass, Pass, Pass),
            (-0.8, Pass, Fail, ConditionalPass),
            (1.0, Pass, Fail, ConditionalPass),
            (1.1, Fail, Fail, ConditionalFail),
            (-1.25, Fail, Fail, ConditionalFail),
            (1.3, Fail, Fail, Fail),
        ] {
            assert_eq!(Rule::Simple.decide(limits, value, 0.25), simple, "{value}");
            assert_eq!(Rule::Guarded(r).decide(limits, value, 0.25), guarded, "{value}");
            assert_eq!(Rule::NonBinary(r).decide(limits, value, 0.25), four, "{value}");
        }
    }

    #[test]
    fn guard_bands_that_leave_no_room() {
        let limits = Limits::new(Some(-1.0), Some(1.0)).unwrap();
        let guarded = Rule::default();
        assert_eq!(guarded.decide(limits, 0.0, 1.0), Status::NotAssessed);
        assert_eq!(guarded.decide(limits, 1.5, 1.0), Status::Fail);
        assert_eq!(guarded.worst_case(limits, &UNIT, 1.0).consumer, None);
        let four = Rule::NonBinary(GuardMultiple::ONE_U);
        assert_eq!(four.decide(limits, 0.0, 1.0), Status::ConditionalPass);
        // One side open: there is always room.
        let at_least = Limits::new(Some(0.0), None).unwrap();
        assert_eq!(guarded.decide(at_least, 5.0, 4.0), Status::Pass);
    }
}
