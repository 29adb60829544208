//! Further terms of the static model (IEEE 1293): which there are, their columns and their units.
//!
//! **Model** `x = k* (N + c(N)) = Δa + a + K2 a² + K3 a³ + ½ K1′ |a| + c_T (T − T̄) + s_T (T − T̄) a`,
//! `a = g sin(φ + Δφ)`. `K1′` is the scale factor for `a > 0` minus that for `a < 0`, relative.

use super::TermEstimate;
use crate::STANDARD_GRAVITY_M_S2;

/// One further term.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Term {
    /// `K2 a²`: second-order nonlinearity.
    K2,
    /// `K3 a³`: third-order nonlinearity.
    K3,
    /// `½ K1′ |a|`: the scale factor differs by sign. `K1′` is that of + minus that of −, relative.
    ScaleSign,
    /// `c_T (T − T̄)`: temperature on the bias.
    TempBias,
    /// `s_T (T − T̄) a`: temperature on the scale factor.
    TempScale,
}

impl Term {
    /// In the order of every list.
    pub const ALL: [Self; 5] =
        [Self::K2, Self::K3, Self::ScaleSign, Self::TempBias, Self::TempScale];

    /// Name on the command line and in the passport.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::K2 => "k2",
            Self::K3 => "k3",
            Self::ScaleSign => "scale-sign",
            Self::TempBias => "temp-bias",
            Self::TempScale => "temp-scale",
        }
    }

    /// For people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::K2 => "second-order nonlinearity K2",
            Self::K3 => "third-order nonlinearity K3",
            Self::ScaleSign => "difference of the scale factors of + and -",
            Self::TempBias => "temperature on the bias",
            Self::TempScale => "temperature on the scale factor",
        }
    }

    /// Unit of its coefficient in SI.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::K2 => "1/(m/s2)",
            Self::K3 => "1/(m/s2)2",
            Self::ScaleSign => "1",
            Self::TempBias => "m/s2/K",
            Self::TempScale => "1/K",
        }
    }

    /// Usual unit of its coefficient, and its factor: `usual = SI × factor`.
    ///
    /// ```
    /// use tumble_core::estimate::Term;
    /// let (unit, factor) = Term::K2.usual();
    /// // 100 µg/g²: the square of 1 g adds 100 µg.
    /// assert_eq!(unit, "ug/g2");
    /// assert!((100.0 / factor * 9.80665 * 9.80665 - 100e-6 * 9.80665).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn usual(self) -> (&'static str, f64) {
        let gn = STANDARD_GRAVITY_M_S2;
        match self {
            Self::K2 => ("ug/g2", 1e6 * gn),
            Self::K3 => ("ug/g3", 1e6 * gn * gn),
            Self::ScaleSign => ("ppm", 1e6),
            Self::TempBias => ("ug/K", 1e6 / gn),
            Self::TempScale => ("ppm/K", 1e6),
        }
    }

    /// A coefficient in the usual unit.
    #[must_use]
    pub fn in_usual_unit(self, value: f64) -> f64 {
        value * self.usual().1
    }

    /// Whether it needs the temperatures of the dwells.
    #[must_use]
    pub fn needs_temperature(self) -> bool {
        matches!(self, Self::TempBias | Self::TempScale)
    }

    /// The term with a name; case and `_` for `-` do not matter.
    #[must_use]
    pub fn from_name(text: &str) -> Option<Self> {
        let wanted = text.trim().to_lowercase().replace('_', "-");
        Self::ALL.into_iter().find(|t| t.name() == wanted)
    }

    /// The term whose name is nearest to a text that is none.
    #[must_use]
    pub fn nearest(text: &str) -> Self {
        let wanted = text.trim().to_lowercase().replace('_', "-");
        // A part of a name stands for it.
        let holds = |t: &Self| wanted.chars().count() > 2 && t.name().contains(&wanted);
        if let Some(t) = Self::ALL.into_iter().find(holds) {
            return t;
        }
        Self::ALL.into_iter().min_by_key(|t| edits(t.name(), &wanted)).unwrap_or(Self::K2)
    }

    /// What a coefficient of one adds at an acceleration and a temperature difference, m/s².
    #[must_use]
    pub fn basis(self, a_m_s2: f64, kelvin: f64) -> f64 {
        match self {
            Self::K2 => a_m_s2 * a_m_s2,
            Self::K3 => a_m_s2 * a_m_s2 * a_m_s2,
            Self::ScaleSign => 0.5 * a_m_s2.abs(),
            Self::TempBias => kelvin,
            Self::TempScale => kelvin * a_m_s2,
        }
    }

    /// Derivative of [`Self::basis`] by the acceleration.
    #[must_use]
    pub fn slope(self, a_m_s2: f64, kelvin: f64) -> f64 {
        match self {
            Self::K2 => 2.0 * a_m_s2,
            Self::K3 => 3.0 * a_m_s2 * a_m_s2,
            // No slope at the kink itself: the mean of both sides.
            Self::ScaleSign if a_m_s2 == 0.0 => 0.0,
            Self::ScaleSign => 0.5 * a_m_s2.signum(),
            Self::TempBias => 0.0,
            Self::TempScale => kelvin,
        }
    }

    fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// Levenshtein distance of two short texts.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(40).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(corner + 1);
        }
    }
    row[b.len()]
}

/// Which further terms stand in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct TermSet(u8);

impl TermSet {
    /// None: bias, misalignment and scale error alone.
    pub const EMPTY: Self = Self(0);

    /// With one more.
    #[must_use]
    pub fn with(self, term: Term) -> Self {
        Self(self.0 | term.bit())
    }

    /// With one less.
    #[must_use]
    pub fn without(self, term: Term) -> Self {
        Self(self.0 & !term.bit())
    }

    /// Whether a term is in.
    #[must_use]
    pub fn contains(self, term: Term) -> bool {
        self.0 & term.bit() != 0
    }

    /// Its terms, in order.
    pub fn iter(self) -> impl Iterator<Item = Term> {
        Term::ALL.into_iter().filter(move |t| self.contains(*t))
    }

    /// How many.
    #[must_use]
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether it has none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}

impl FromIterator<Term> for TermSet {
    fn from_iter<I: IntoIterator<Item = Term>>(terms: I) -> Self {
        terms.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// Which further terms an assessment enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TermChoice {
    /// Every term is tried; it enters where the data ask for it and the plan bears it.
    Auto,
    /// These, whether significant or not; the empty set is none.
    Named(TermSet),
}

impl Default for TermChoice {
    /// None: a curve that is left over may be the table's, and nobody but the user can tell.
    fn default() -> Self {
        Self::Named(TermSet::EMPTY)
    }
}

impl TermChoice {
    /// The set that was named; none where the choice is left to the data.
    #[must_use]
    pub fn named(self) -> TermSet {
        match self {
            Self::Auto => TermSet::EMPTY,
            Self::Named(set) => set,
        }
    }
}

/// What terms add at an acceleration and a temperature difference, m/s².
#[must_use]
pub fn added_m_s2(terms: &[TermEstimate], a_m_s2: f64, kelvin: f64) -> f64 {
    terms.iter().map(|t| t.value * t.term.basis(a_m_s2, kelvin)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_and_near_ones_are_found() {
        for t in Term::ALL {
            assert_eq!(Term::from_name(&t.name().to_uppercase().replace('-', "_")), Some(t));
        }
        for (typed, meant) in [
            ("k4", Term::K2),
            ("K3x", Term::K3),
            ("temp-bais", Term::TempBias),
            ("tempscale", Term::TempScale),
            ("sign", Term::ScaleSign),
        ] {
            assert_eq!(Term::from_name(typed), None);
            assert_eq!(Term::nearest(typed), meant, "{typed}");
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        for t in Term::ALL {
            for a in [-9.0, -0.3, 0.4, 9.8] {
                let h = 1e-5;
                let numeric = (t.basis(a + h, 3.0) - t.basis(a - h, 3.0)) / (2.0 * h);
                assert!((numeric - t.slope(a, 3.0)).abs() < 1e-6, "{t:?} at {a}");
            }
        }
    }

    #[test]
    fn sets_hold_what_was_put_in() {
        let set: TermSet = [Term::TempBias, Term::K2].into_iter().collect();
        assert_eq!(set.iter().collect::<Vec<_>>(), [Term::K2, Term::TempBias]);
        assert_eq!(set.without(Term::K2).len(), 1);
        assert!(TermSet::EMPTY.is_empty() && !set.contains(Term::K3));
    }
}
