//! Tolerance limits, one-sided or two-sided.

/// Limits that a quantity has to keep: at least one, and the lower below the upper.
///
/// A value at a limit conforms (JCGM 106: the tolerance interval includes its limits).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    lower: Option<f64>,
    upper: Option<f64>,
}

impl Limits {
    /// Limits; `None` where both are absent, one is not finite, or the lower does not lie below the upper.
    ///
    /// ```
    /// use tumble_core::decision::Limits;
    /// let two_sided = Limits::new(Some(-0.25), Some(0.25)).unwrap();
    /// assert_eq!(two_sided.width(), Some(0.5));
    /// assert_eq!(Limits::new(None, Some(1.0)).unwrap().width(), None);
    /// assert_eq!(Limits::new(Some(1.0), Some(-1.0)), None);
    /// assert_eq!(Limits::new(None, None), None);
    /// ```
    #[must_use]
    pub fn new(lower: Option<f64>, upper: Option<f64>) -> Option<Self> {
        let finite = lower.into_iter().chain(upper).all(f64::is_finite);
        let in_order = match (lower, upper) {
            (Some(lower), Some(upper)) => lower < upper && (upper - lower).is_finite(),
            (lower, upper) => lower.is_some() || upper.is_some(),
        };
        (finite && in_order).then_some(Self { lower, upper })
    }

    /// The lower limit; `None` where the quantity may be as low as it likes.
    #[must_use]
    pub fn lower(self) -> Option<f64> {
        self.lower
    }

    /// The upper limit; `None` where the quantity may be as high as it likes.
    #[must_use]
    pub fn upper(self) -> Option<f64> {
        self.upper
    }

    /// Lower and upper, infinite where open.
    #[must_use]
    pub fn ends(self) -> (f64, f64) {
        (self.lower.unwrap_or(f64::NEG_INFINITY), self.upper.unwrap_or(f64::INFINITY))
    }

    /// The tolerance `T_U − T_L`; `None` where one side is open.
    #[must_use]
    pub fn width(self) -> Option<f64> {
        Some(self.upper? - self.lower?)
    }

    /// Whether a value keeps the limits.
    #[must_use]
    pub fn contain(self, value: f64) -> bool {
        let (lower, upper) = self.ends();
        lower <= value && value <= upper
    }

    /// Both limits moved inward (outward where negative) by a guard band; `None` where nothing is left between them.
    #[must_use]
    pub fn moved_inward(self, guard_band: f64) -> Option<Self> {
        Self::new(self.lower.map(|l| l + guard_band), self.upper.map(|u| u - guard_band))
    }
}
