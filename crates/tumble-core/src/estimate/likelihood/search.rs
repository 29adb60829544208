//! Where a falling derivative crosses zero.

/// A function's derivative at a point, and the point.
#[derive(Clone, Copy)]
struct Slope {
    x: f64,
    slope: f64,
}

/// Where a falling derivative crosses zero: by steps uphill, then by regula falsi (Illinois), which cannot leave its
/// bracket. Ends at the bounds where it never does. The second figure is the curvature there.
pub(super) fn crossing(
    start: f64,
    step: f64,
    bounds: (f64, f64),
    worth: f64,
    mut slope_at: impl FnMut(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    let mut here = Slope { x: start, slope: slope_at(start)? };
    let mut step = step * here.slope.signum();
    let mut bracket = None;
    for _ in 0..40 {
        let x = (here.x + step).clamp(bounds.0, bounds.1);
        if x == here.x {
            return Some((here.x, 0.0));
        }
        let next = Slope { x, slope: slope_at(x)? };
        if next.slope.signum() != here.slope.signum() {
            bracket = Some((here, next));
            break;
        }
        // A secant step, when it points on, else a longer one.
        let secant = -next.slope * (next.x - here.x) / (next.slope - here.slope);
        step = if secant * step > 0.0 {
            (1.3 * secant).abs().clamp(0.3 * step.abs(), 3.0 * step.abs()) * step.signum()
        } else {
            2.0 * step
        };
        here = next;
    }
    let (mut a, mut b) = bracket?;
    let (mut weight_a, mut weight_b) = (1.0, 1.0);
    for _ in 0..40 {
        let curvature = (b.slope - a.slope) / (b.x - a.x);
        // What is still to gain between the ends.
        let best = if a.slope.abs() < b.slope.abs() { a } else { b };
        if best.slope.abs().min(a.slope.abs()) * (b.x - a.x).abs() < worth
            || (b.x - a.x).abs() < 1e-4
        {
            let x = best.x - best.slope / curvature;
            return Some((x, curvature));
        }
        let (fa, fb) = (a.slope * weight_a, b.slope * weight_b);
        let x = (a.x * fb - b.x * fa) / (fb - fa);
        let mid = Slope { x, slope: slope_at(x)? };
        if mid.slope.signum() == a.slope.signum() {
            a = mid;
            (weight_a, weight_b) = (1.0, 0.5 * weight_b);
        } else {
            b = mid;
            (weight_a, weight_b) = (0.5 * weight_a, 1.0);
        }
    }
    Some((0.5 * (a.x + b.x), (b.slope - a.slope) / (b.x - a.x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crossing_is_found_and_the_bounds_are_kept() {
        let (x, curvature) =
            crossing(0.0, 0.1, (-5.0, 5.0), 1e-4, |x| Some(10.0 * (2.0 - x))).unwrap();
        assert!((x - 2.0).abs() < 1e-9 && (curvature + 10.0).abs() < 1e-9);
        let (x, _) =
            crossing(0.0, 0.1, (-5.0, 5.0), 1e-4, |x| Some(-(x + 3.0).exp() + 1e-3)).unwrap();
        assert!((x - -5.0).abs() < 1e-9);
        let (x, _) =
            crossing(3.0, 0.3, (-5.0, 5.0), 1e-4, |x| Some(100.0 * (0.3 - x.powi(3)))).unwrap();
        assert!((x - 0.3f64.cbrt()).abs() < 0.01, "{x}");
    }
}
