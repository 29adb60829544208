//! Points in a frame of characters.

/// What a figure spans: from left to right, from bottom to top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
}

impl Span {
    /// Of some points; `None` where they are fewer than three or lie on one line along an axis.
    pub(crate) fn of(points: &[(f64, f64)]) -> Option<Self> {
        let range = |of: &dyn Fn(&(f64, f64)) -> f64| {
            points
                .iter()
                .map(of)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (x, y) = (range(&|p| p.0), range(&|p| p.1));
        (points.len() >= 3 && x.1 > x.0 && y.1 > y.0).then_some(Self { x, y })
    }
}
