//! Codes of one dwell, counted.

use std::collections::BTreeMap;

use crate::Code;

/// Widest span of codes that is counted in one array; what lies farther out goes into a map.
const DENSE_SPAN: i64 = 1 << 14;

/// How often each code was read in one dwell.
///
/// Everything that the within-dwell likelihood needs, in little room. All sums are integers: merging is
/// associative and commutative, and the result does not depend on the order of the rows.
///
/// ```
/// use tumble_core::{Code, CodeHistogram};
/// let (mut a, mut b) = (CodeHistogram::default(), CodeHistogram::default());
/// for n in [5, 7, 7] { a.record(Code(n)); }
/// b.record(Code(6));
/// a.merge(&b);
/// assert_eq!(a.samples(), 4);
/// assert_eq!(a.mean(), Some(6.25));
/// assert_eq!(a.bins().collect::<Vec<_>>(), [(Code(5), 1), (Code(6), 1), (Code(7), 2)]);
/// ```
#[derive(Debug, Clone, Default)]
pub struct CodeHistogram {
    /// Code of `dense[0]`.
    base: i64,
    dense: Vec<u64>,
    far: BTreeMap<i32, u64>,
    samples: u64,
}

impl CodeHistogram {
    /// Counts one code.
    #[inline]
    pub fn record(&mut self, code: Code) {
        self.record_many(code, 1);
    }

    /// Counts one code `times` times.
    #[inline]
    pub fn record_many(&mut self, code: Code, times: u64) {
        if times == 0 {
            return;
        }
        let offset = i64::from(code.0) - self.base;
        match usize::try_from(offset).ok().and_then(|i| self.dense.get_mut(i)) {
            Some(count) => *count += times,
            None => self.record_outside(code, times),
        }
        self.samples += times;
    }

    /// Grows the dense array toward a code, or counts it far out.
    fn record_outside(&mut self, code: Code, times: u64) {
        let n = i64::from(code.0);
        let (lo, hi) = if self.dense.is_empty() {
            (n - 8, n + 8)
        } else {
            let end = self.base + self.dense.len() as i64;
            (self.base.min(n - 8), end.max(n + 8))
        };
        if hi - lo > DENSE_SPAN {
            *self.far.entry(code.0).or_insert(0) += times;
            return;
        }
        let front = if self.dense.is_empty() { 0 } else { (self.base - lo) as usize };
        let mut grown = vec![0; (hi - lo) as usize];
        grown[front..front + self.dense.len()].copy_from_slice(&self.dense);
        grown[(n - lo) as usize] += times;
        // What was counted far out and now lies inside moves in: every code has one place.
        self.far.retain(|&far, &mut count| match usize::try_from(i64::from(far) - lo) {
            Ok(i) if i < grown.len() => {
                grown[i] += count;
                false
            }
            _ => true,
        });
        (self.base, self.dense) = (lo, grown);
    }

    /// Adds another dwell's counts.
    pub fn merge(&mut self, other: &Self) {
        for (code, count) in other.bins() {
            self.record_many(code, count);
        }
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Codes that occur, ascending, with their counts.
    pub fn bins(&self) -> impl Iterator<Item = (Code, u64)> + '_ {
        let dense = self
            .dense
            .iter()
            .enumerate()
            .filter(|(_, c)| **c > 0)
            .map(|(i, c)| (Code((self.base + i as i64) as i32), *c));
        let far = |above: bool| {
            self.far
                .iter()
                .filter(move |(n, _)| (i64::from(**n) >= self.base) == above)
                .map(|(n, c)| (Code(*n), *c))
        };
        far(false).chain(dense).chain(far(true))
    }

    /// Number of different codes.
    #[must_use]
    pub fn distinct(&self) -> usize {
        self.bins().count()
    }

    /// Lowest and highest code.
    #[must_use]
    pub fn extent(&self) -> Option<(Code, Code)> {
        self.bins().fold(None, |e, (c, _)| {
            Some(e.map_or((c, c), |(lo, hi): (Code, Code)| (lo.min(c), hi.max(c))))
        })
    }

    /// Exact sums of the codes and of their squares.
    #[must_use]
    pub fn sums(&self) -> (i128, i128) {
        self.bins().fold((0, 0), |(s, q), (c, k)| {
            let (n, k) = (i128::from(c.0), i128::from(k));
            (s + k * n, q + k * n * n)
        })
    }

    /// Mean code.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.samples > 0).then(|| self.sums().0 as f64 / self.samples as f64)
    }

    /// Sample standard deviation (n − 1) of the codes; `None` below two samples.
    #[must_use]
    pub fn std(&self) -> Option<f64> {
        let (s, q) = self.sums();
        crate::readings::std_from_sums(s, q, self.samples)
    }
}

impl PartialEq for CodeHistogram {
    fn eq(&self, other: &Self) -> bool {
        self.samples == other.samples && self.bins().eq(other.bins())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn counted(codes: &[i32]) -> CodeHistogram {
        let mut h = CodeHistogram::default();
        codes.iter().for_each(|n| h.record(Code(*n)));
        h
    }

    fn codes() -> impl Strategy<Value = Vec<i32>> {
        let near = -50..50i32;
        let wide = -40_000..40_000i32;
        prop::collection::vec(prop_oneof![8 => near, 2 => wide, 1 => any::<i32>()], 0..200)
    }

    proptest! {
        #[test]
        fn merging_is_associative_and_commutative(a in codes(), b in codes(), c in codes()) {
            let all = counted(&[a.clone(), b.clone(), c.clone()].concat());
            let (a, b, c) = (counted(&a), counted(&b), counted(&c));
            let mut left = a.clone();
            left.merge(&b);
            left.merge(&c);
            let mut right = c;
            let mut ba = b;
            ba.merge(&a);
            right.merge(&ba);
            prop_assert_eq!(&left, &right);
            prop_assert_eq!(&left, &all);
        }

        #[test]
        fn bins_are_ascending_and_complete(a in codes()) {
            let h = counted(&a);
            let mut expected = BTreeMap::new();
            a.iter().for_each(|n| *expected.entry(*n).or_insert(0u64) += 1);
            let got: Vec<_> = h.bins().map(|(c, k)| (c.0, k)).collect();
            prop_assert_eq!(got, expected.into_iter().collect::<Vec<_>>());
        }
    }

    #[test]
    fn standard_deviation_has_n_minus_one() {
        assert_eq!(counted(&[1, 3]).std(), Some(2f64.sqrt()));
        assert_eq!(counted(&[1]).std(), None);
        assert_eq!(counted(&[]).mean(), None);
    }
}
