//! Which dwells of a run do not fit the others, however many hide one another.
//!
//! Deleting the worst dwell first fails where several are wrong: together they widen the scatter that each is held
//! against. So the fit starts from the dwells that agree best and grows; what does not come in is held against those
//! that did.

use crate::linalg::{Symmetric3, dot3};
use crate::stats::student_p_value;
use crate::{Position, Quantizer, Seat};

/// Fewest dwells for leaving one out: two degrees of freedom remain.
pub(crate) const FEWEST: usize = 6;
/// One dwell of so many may be wrong; more are no single dwells but another fault of the run.
pub(crate) const WRONG_SHARE: usize = 6;
/// Level of the test for a whole run, Bonferroni over its dwells: an experiment of five honest runs raises it once
/// in two thousand.
pub(crate) const LEVEL: f64 = 1e-4;
/// Unknowns of the exact form.
const UNKNOWNS: usize = 3;
/// Triples that the search starts from. With a sixth of the dwells wrong, more than half of them are clean.
const STARTS: usize = 60;
/// Least scatter that is believed, rad of table angle: data made by a formula have none.
pub(crate) const LEAST_SCATTER_RAD: f64 = 2e-5;
/// Least cosine in the shape of an angle's scatter.
const LEAST_COSINE: f64 = 0.2;
/// Scatter, rad of table angle, from which the run does not follow its angles: no dwell is singled out.
const HOPELESS_RAD: f64 = 0.01;

/// One dwell on the table, as the fit takes it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// Index among the positions that were handed over.
    pub index: usize,
    /// Table angle, rad.
    pub angle_rad: f64,
    /// Level that its mean stands for, LSB.
    pub level_lsb: f64,
    /// What quantization may do to the level, LSB.
    pub allowance_lsb: f64,
    /// Variance of its mean beyond that of the typical dwell, LSB².
    pub excess_lsb2: f64,
}

/// Dwells on the table as points: those with a mean, not stood upright.
pub(super) fn points(positions: &[&Position], quantizer: Quantizer) -> Vec<Point> {
    let deviations: Vec<f64> = positions.iter().filter_map(|p| p.readings.std()).collect();
    let noise = super::robust::median(&deviations);
    let code_variance = crate::stats::mean(&deviations.iter().map(|s| s * s).collect::<Vec<_>>());
    let variance =
        |p: &Position| p.readings.variance_of_mean(quantizer, code_variance.unwrap_or(0.0));
    let variances: Vec<f64> = positions.iter().map(|p| variance(p)).collect();
    let typical = super::robust::median(&variances).unwrap_or(0.0);
    positions
        .iter()
        .enumerate()
        .filter(|(_, p)| p.seat == Seat::Table)
        .filter_map(|(index, p)| {
            let mean = p.readings.mean()?;
            Some(Point {
                index,
                angle_rad: p.angle.rad(),
                level_lsb: quantizer.analogue_lsb(mean),
                allowance_lsb: allowance(quantizer, mean, noise),
                excess_lsb2: (variance(p) - typical).max(0.0),
            })
        })
        .collect()
}

/// How far the level that a mean stands for may be off, LSB: half where no noise dithers, one near zero of a
/// truncating converter, whose code 0 is two wide.
fn allowance(quantizer: Quantizer, mean: f64, noise: Option<f64>) -> f64 {
    let sigma = noise.unwrap_or(0.0);
    let near_zero = quantizer == Quantizer::Truncate && mean.abs() <= 1.0 + 4.0 * sigma;
    match quantizer {
        Quantizer::None => 0.0,
        _ if near_zero => 1.0,
        _ if sigma < 0.5 => 0.5,
        _ => 0.0,
    }
}

/// Columns `1, sin(φ−φ0), 1 − cos(φ−φ0)` in unit size: the same space as `1, sinφ, cosφ`, well conditioned also
/// over a narrow arc.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Columns {
    centre_rad: f64,
    sine: f64,
    versine: f64,
}

impl Columns {
    fn of(points: &[Point]) -> Self {
        let angles: Vec<f64> = points.iter().map(|p| p.angle_rad).collect();
        let centre_rad = super::robust::median(&angles).unwrap_or(0.0);
        let largest =
            |f: fn(f64) -> f64| angles.iter().map(|a| f(a - centre_rad).abs()).fold(1e-9, f64::max);
        Self { centre_rad, sine: largest(f64::sin), versine: largest(|x| 1.0 - x.cos()) }
    }

    fn row(&self, angle_rad: f64) -> [f64; 3] {
        let (s, c) = (angle_rad - self.centre_rad).sin_cos();
        [1.0, s / self.sine, (1.0 - c) / self.versine]
    }
}

/// A weighted fit to some of the points.
#[derive(Debug, Clone, Copy)]
struct Solution {
    b: [f64; 3],
    inverse: Symmetric3,
    squares: f64,
    members: usize,
}

/// Rows, levels and weights of all points, for one shape of the scatter.
struct Problem<'a> {
    points: &'a [Point],
    rows: Vec<[f64; 3]>,
    weights: Vec<f64>,
    least_variance: f64,
}

impl Problem<'_> {
    fn solve(&self, members: &[usize]) -> Option<Solution> {
        let mut normal = Symmetric3::default();
        let mut right = [0.0; 3];
        for &i in members {
            normal.add_outer(self.rows[i], self.weights[i]);
            for (r, x) in right.iter_mut().zip(self.rows[i]) {
                *r += self.weights[i] * x * self.points[i].level_lsb;
            }
        }
        let (inverse, _) = normal.inverse()?;
        let b = inverse.times(right);
        let squares = members.iter().map(|&i| self.weights[i] * self.residual(b, i).powi(2)).sum();
        Some(Solution { b, inverse, squares, members: members.len() })
    }

    fn residual(&self, b: [f64; 3], i: usize) -> f64 {
        self.points[i].level_lsb - dot3(b, self.rows[i])
    }

    /// The points that a solution fits best.
    fn nearest(&self, b: [f64; 3], size: usize) -> Vec<usize> {
        let mut order: Vec<(f64, usize)> = (0..self.points.len())
            .map(|i| (self.weights[i] * self.residual(b, i).powi(2), i))
            .collect();
        if size < order.len() {
            order.select_nth_unstable_by(size, |x, y| x.0.total_cmp(&y.0));
            order.truncate(size);
        }
        order.into_iter().map(|(_, i)| i).collect()
    }

    /// Variance of one observation of unit weight.
    fn variance(&self, s: &Solution) -> f64 {
        let dof = s.members.saturating_sub(UNKNOWNS).max(1) as f64;
        (s.squares / dof).max(self.least_variance)
    }

    /// Deleted residual of a point that is not in the fit, over its standard deviation.
    fn studentized(&self, s: &Solution, i: usize) -> f64 {
        let (p, row) = (&self.points[i], self.rows[i]);
        let spread =
            self.variance(s) * (1.0 / self.weights[i] + s.inverse.quadratic(row)) + p.excess_lsb2;
        (self.residual(s.b, i).abs() - p.allowance_lsb).max(0.0) / spread.sqrt()
    }

    /// Subset of a given size with the least squares: concentration steps from many triples.
    ///
    /// **Source** P. J. Rousseeuw, K. Van Driessen, *Computing LTS regression for large data sets* (2006).
    fn best_subset(&self, size: usize) -> Option<Vec<usize>> {
        let n = self.points.len();
        let mut by_angle: Vec<usize> = (0..n).collect();
        by_angle.sort_by(|a, b| {
            self.points[*a].angle_rad.total_cmp(&self.points[*b].angle_rad).then(a.cmp(b))
        });
        let thirds = [0, n / 3, 2 * n / 3, n];
        let mut best: Option<(f64, Vec<usize>)> = None;
        for start in 0..STARTS {
            // One dwell of each third, in steps that share no factor with the usual numbers of dwells.
            let triple: Vec<usize> = (0..3)
                .map(|t| {
                    let width = thirds[t + 1] - thirds[t];
                    by_angle[thirds[t] + (start * [1, 7, 13][t] + start / width) % width]
                })
                .collect();
            let Some(mut s) = self.solve(&triple) else { continue };
            let mut members = triple;
            for _ in 0..3 {
                members = self.nearest(s.b, size);
                match self.solve(&members) {
                    Some(next) => s = next,
                    None => break,
                }
            }
            if s.members == size && best.as_ref().is_none_or(|(q, _)| s.squares < *q) {
                best = Some((s.squares, members));
            }
        }
        best.map(|(_, members)| members)
    }

    /// Points outside the smallest subset that the next one does not join by chance.
    ///
    /// **Model** at each size `k` the point that fits best among those outside has a deleted residual `t`, Student
    /// with `k − 3` degrees of freedom; beyond the level divided by `k + 1` all of those outside are wrong.
    /// **Source** B. Rosner, *Percentage points for a generalized ESD many-outlier procedure* (1983); the growing
    /// subset of A. C. Atkinson and M. Riani (2000).
    fn outsiders(&self, most: usize) -> Vec<usize> {
        let n = self.points.len();
        let Some(mut members) = self.best_subset(n - most) else { return Vec::new() };
        for size in n - most..n {
            let Some(s) = self.solve(&members) else { return Vec::new() };
            let mut inside = vec![false; n];
            members.iter().for_each(|&i| inside[i] = true);
            let outside: Vec<usize> = (0..n).filter(|i| !inside[*i]).collect();
            let next =
                outside.iter().map(|&i| self.studentized(&s, i)).fold(f64::INFINITY, f64::min);
            let p = student_p_value(next, (size - UNKNOWNS) as f64).unwrap_or(1.0);
            if p * (size as f64 + 1.0) < LEVEL {
                return outside;
            }
            members = self.nearest(s.b, size + 1);
        }
        Vec::new()
    }
}

/// A run's dwells, fitted without those that do not fit.
#[derive(Debug, Clone)]
pub(super) struct DwellFit {
    /// All points, in measured order.
    pub points: Vec<Point>,
    /// Which of them are left out, by their place among `points`.
    pub wrong: Vec<usize>,
    /// Scatter of the others, LSB.
    pub scatter_lsb: f64,
    /// Degrees of freedom of the scatter.
    pub degrees_of_freedom: f64,
    columns: Columns,
    solution: Solution,
}

impl DwellFit {
    /// Fits a run. `None` where the dwells are too few to leave one out, or do not follow their angles at all.
    ///
    /// Scatter that comes from the angles goes with their cosine, the rest does not; a dwell is wrong when it is
    /// wrong for both.
    pub fn of(points: Vec<Point>) -> Option<Self> {
        let n = points.len();
        if n < FEWEST {
            return None;
        }
        let most = n / WRONG_SHARE;
        let columns = Columns::of(&points);
        let rows: Vec<[f64; 3]> = points.iter().map(|p| columns.row(p.angle_rad)).collect();
        let everything: Vec<usize> = (0..n).collect();
        let problem = |weights: Vec<f64>, least_variance: f64| Problem {
            points: &points,
            rows: rows.clone(),
            weights,
            least_variance,
        };
        let start = problem(vec![1.0; n], 0.0);
        let robust = start.best_subset(n - most).and_then(|m| start.solve(&m))?;
        let slope = (robust.b[1] / columns.sine).abs();
        let least = (LEAST_SCATTER_RAD * slope).powi(2).max(f64::MIN_POSITIVE);
        let constant = problem(vec![1.0; n], least);
        let cosine = |p: &Point| p.angle_rad.cos().abs().max(LEAST_COSINE).powi(-2);
        let with_cosine = problem(points.iter().map(cosine).collect(), least);
        let mut wrong = constant.outsiders(most);
        if !wrong.is_empty() {
            let also = with_cosine.outsiders(most);
            wrong.retain(|i| also.contains(i));
        }
        let kept: Vec<usize> = everything.into_iter().filter(|i| !wrong.contains(i)).collect();
        let solution = constant.solve(&kept)?;
        let scatter_lsb = constant.variance(&solution).sqrt();
        if scatter_lsb > HOPELESS_RAD * (solution.b[1] / columns.sine).abs() {
            return None;
        }
        let degrees_of_freedom = (kept.len() - UNKNOWNS) as f64;
        Some(Self { points, wrong, scatter_lsb, degrees_of_freedom, columns, solution })
    }

    /// Level that the fit expects at a table angle, LSB, and its standard deviation for one more dwell.
    pub fn expected_lsb(&self, angle_rad: f64) -> (f64, f64) {
        let row = self.columns.row(angle_rad);
        let variance = 1.0 + self.solution.inverse.quadratic(row);
        (dot3(self.solution.b, row), self.scatter_lsb * variance.sqrt())
    }

    /// Read minus expected, LSB.
    pub fn residual_lsb(&self, point: usize) -> f64 {
        let p = &self.points[point];
        p.level_lsb - self.expected_lsb(p.angle_rad).0
    }

    /// `α` and `R`, LSB: the fit reads `α ± R` with the axis up and down.
    pub fn ends(&self) -> (f64, f64) {
        // b0 + v + s·sin x − v·cos x = α + R sin(x + ψ), x = φ − φ0
        let (sine, versine) = self.unscaled();
        (self.solution.b[0] + versine, sine.hypot(versine))
    }

    fn phase_rad(&self) -> f64 {
        let (sine, versine) = self.unscaled();
        (-versine).atan2(sine)
    }

    fn unscaled(&self) -> (f64, f64) {
        let [_, b1, b2] = self.solution.b;
        (b1 / self.columns.sine, b2 / self.columns.versine)
    }

    /// Table angle, rad, at which the fit reads a level, with the slope there, LSB per rad. Of the two the one
    /// nearer to the angles of the run; `None` where none reads it.
    pub fn angle_of(&self, level_lsb: f64) -> Option<(f64, f64)> {
        use core::f64::consts::PI;
        let ((alpha, amplitude), psi) = (self.ends(), self.phase_rad());
        let argument = (level_lsb - alpha) / amplitude;
        if !(amplitude > 0.0 && argument.abs() < 1.0) {
            return None;
        }
        let angles = || {
            (0..self.points.len())
                .filter(|i| !self.wrong.contains(i))
                .map(|i| self.points[i].angle_rad)
        };
        let middle = 0.5
            * (angles().fold(f64::INFINITY, f64::min) + angles().fold(f64::NEG_INFINITY, f64::max));
        let wrapped = |x: f64| middle + (x - middle + PI).rem_euclid(2.0 * PI) - PI;
        [argument.asin(), PI - argument.asin()]
            .map(|x| wrapped(self.columns.centre_rad - psi + x))
            .into_iter()
            .min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()))
            .map(|angle| (angle, amplitude * (1.0 - argument * argument).sqrt()))
    }

    /// The wrong dwells that stick out among their neighbours in the order of the angles, and whether they do in that
    /// of time.
    ///
    /// A curve carries its neighbours along, and so does a drift; a slip does not. Where half of the wrong dwells do
    /// not stick out, the run has another fault, and none is blamed.
    pub fn alone(&self) -> Vec<(usize, bool)> {
        let n = self.points.len();
        let in_time: Vec<usize> = (0..n).collect();
        let mut by_angle = in_time.clone();
        by_angle.sort_by(|a, b| {
            self.points[*a].angle_rad.total_cmp(&self.points[*b].angle_rad).then(a.cmp(b))
        });
        let sticks_out = self.sticking_out(&by_angle);
        let sticks_out_in_time = self.sticking_out(&in_time);
        if 2 * sticks_out.len() <= self.wrong.len() {
            return Vec::new();
        }
        // A group that moved together has edges that stick out.
        let in_time_counts = 2 * sticks_out_in_time.len() > self.wrong.len();
        sticks_out
            .into_iter()
            .map(|i| (i, in_time_counts && sticks_out_in_time.contains(&i)))
            .collect()
    }

    /// Which of the wrong dwells differ from their neighbours in an order.
    fn sticking_out(&self, order: &[usize]) -> Vec<usize> {
        let residuals: Vec<f64> = (0..self.points.len()).map(|i| self.residual_lsb(i)).collect();
        let steps = against_neighbours(&residuals, order);
        let kept = (0..residuals.len()).filter(|i| !self.wrong.contains(i)).map(|i| {
            // Beside a wrong dwell a right one sticks out too: its own residual is the better measure.
            steps[i].abs().min(2.0 * residuals[i].abs())
        });
        let usual = crate::stats::root_mean_square(kept).unwrap_or(0.0).max(self.scatter_lsb);
        self.wrong.iter().copied().filter(|i| steps[*i].abs() > STICKS_OUT * usual).collect()
    }
}

/// Difference to the neighbours, in units of what is usual in the run, from which a dwell sticks out. No test of its
/// own, only a filter behind one: rms differences of honest neighbours are 1.2 times the scatter.
const STICKS_OUT: f64 = 4.0;

/// Each value minus what its neighbours in an order make of it: their mean, at the ends the straight line.
fn against_neighbours(values: &[f64], order: &[usize]) -> Vec<f64> {
    let n = order.len();
    let at = |k: usize| values[order[k]];
    let mut out = vec![0.0; values.len()];
    for k in 0..n {
        let neighbours = match k {
            0 => 2.0 * at(1) - at(2),
            _ if k + 1 == n => 2.0 * at(n - 2) - at(n - 3),
            _ => 0.5 * (at(k - 1) + at(k + 1)),
        };
        out[order[k]] = at(k) - neighbours;
    }
    out
}
