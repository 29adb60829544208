//! Units and the newtypes where mixing them would be fatal.

/// One standard acceleration of free fall, m/s². A **unit** (exact by definition), never the local gravity.
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// One minute of arc in radians.
pub const ARCMIN_RAD: f64 = core::f64::consts::PI / (180.0 * 60.0);

/// A plane angle.
///
/// **Units** radians inside, degrees only at the edges. **Sign** positive when the sensitive axis points up,
/// zero when it is horizontal.
///
/// ```
/// use tumble_core::Angle;
/// assert!((Angle::from_deg(30.0).sin() - 0.5).abs() < 1e-15);
/// assert!((Angle::from_arcmin(60.0).deg() - 1.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Angle(f64);

impl Angle {
    /// From radians.
    #[must_use]
    pub const fn from_rad(rad: f64) -> Self {
        Self(rad)
    }
    /// From degrees.
    #[must_use]
    pub fn from_deg(deg: f64) -> Self {
        Self(deg.to_radians())
    }
    /// From minutes of arc.
    #[must_use]
    pub fn from_arcmin(arcmin: f64) -> Self {
        Self(arcmin * ARCMIN_RAD)
    }
    /// In radians.
    #[must_use]
    pub const fn rad(self) -> f64 {
        self.0
    }
    /// In degrees.
    #[must_use]
    pub fn deg(self) -> f64 {
        self.0.to_degrees()
    }
    /// In minutes of arc.
    #[must_use]
    pub fn arcmin(self) -> f64 {
        self.0 / ARCMIN_RAD
    }
    /// Sine.
    #[must_use]
    pub fn sin(self) -> f64 {
        self.0.sin()
    }
    /// Cosine.
    #[must_use]
    pub fn cos(self) -> f64 {
        self.0.cos()
    }
}

/// One integer code of the converter (LSB).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub i32);
