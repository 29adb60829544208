//! Slips of the pen: which number was meant where another is typed.

/// What went wrong while a number was typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slip {
    /// The angle before it, or after it, was typed again.
    NotAdvanced,
    /// A sign lost or added.
    Sign,
    /// Two neighbouring digits changed places.
    Transposed,
    /// The decimal point is missing or elsewhere.
    Point,
    /// A digit typed twice.
    Doubled,
    /// A digit left out.
    LeftOut,
    /// One digit is another.
    Digit,
}

impl Slip {
    /// Whether few numbers are one such slip away: a fit is hardly chance.
    pub fn is_telling(self) -> bool {
        !matches!(self, Self::LeftOut | Self::Digit)
    }

    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::NotAdvanced => "a neighbour's angle typed again",
            Self::Sign => "the sign",
            Self::Transposed => "digits transposed",
            Self::Point => "the decimal point",
            Self::Doubled => "a digit typed twice",
            Self::LeftOut => "a digit left out",
            Self::Digit => "one digit",
        }
    }
}

/// Digits of a typed number.
#[derive(Debug, Clone, PartialEq)]
struct Typed {
    negative: bool,
    digits: Vec<u8>,
    decimals: usize,
}

impl Typed {
    /// A plain decimal number, with point or comma.
    fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let negative = text.starts_with(['-', '−']);
        let body = text.trim_start_matches(['-', '−', '+']);
        let (whole, fraction) = body.split_once(['.', ',']).unwrap_or((body, ""));
        let digits: Vec<u8> = whole.bytes().chain(fraction.bytes()).collect();
        // More digits than a dial has would overflow the sum below.
        let plain = (1..=15).contains(&digits.len()) && digits.iter().all(u8::is_ascii_digit);
        plain.then(|| Self {
            negative,
            digits: digits.iter().map(|d| d - b'0').collect(),
            decimals: fraction.len(),
        })
    }

    fn value(&self) -> f64 {
        let whole = self.digits.iter().fold(0.0, |sum, d| 10.0 * sum + f64::from(*d));
        let size = whole / 10f64.powi(self.decimals as i32);
        if self.negative { -size } else { size }
    }

    fn with(&self, change: impl FnOnce(&mut Vec<u8>)) -> f64 {
        let mut other = self.clone();
        change(&mut other.digits);
        other.value()
    }

    fn transposed(&self) -> impl Iterator<Item = f64> + '_ {
        (1..self.digits.len()).map(|i| self.with(|d| d.swap(i - 1, i)))
    }

    fn doubled(&self) -> impl Iterator<Item = f64> + '_ {
        (1..self.digits.len()).filter(|i| self.digits[*i] == self.digits[i - 1]).map(|i| {
            let mut other = self.clone();
            other.digits.remove(i);
            if i >= self.digits.len() - self.decimals {
                other.decimals -= 1;
            }
            other.value()
        })
    }

    fn left_out(&self) -> impl Iterator<Item = f64> + '_ {
        let whole = self.digits.len() - self.decimals;
        (0..=self.digits.len()).flat_map(move |i| {
            (0..10u8).map(move |digit| {
                let mut other = self.clone();
                other.digits.insert(i, digit);
                if i > whole {
                    other.decimals += 1;
                }
                other.value()
            })
        })
    }

    fn replaced(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.digits.len())
            .flat_map(move |i| (0..10u8).map(move |digit| self.with(|d| d[i] = digit)))
    }
}

/// Decimals of a typed number; none where it is no plain number.
pub(super) fn decimals(typed: &str) -> usize {
    Typed::parse(typed).map_or(0, |t| t.decimals)
}

/// The number that was meant: one slip away from the one typed, and within `tolerance` of what fits.
///
/// It must explain the difference, not only lie near: the tolerance is at most a quarter of the change.
/// `neighbours` are numbers typed before and after, the nearest first.
pub(super) fn explain(
    typed: &str,
    value: f64,
    neighbours: [&[f64]; 2],
    fits: f64,
    tolerance: f64,
) -> Option<(Slip, f64)> {
    let number = Typed::parse(typed).or_else(|| Typed::parse(&value.to_string()));
    let mut candidates: Vec<(Slip, f64)> =
        not_advanced(value, neighbours).into_iter().map(|v| (Slip::NotAdvanced, v)).collect();
    candidates.push((Slip::Sign, -value));
    if let Some(n) = &number {
        candidates.extend(n.transposed().map(|v| (Slip::Transposed, v)));
    }
    // A point that neither number has cannot be the slip.
    let pointed = number.as_ref().is_some_and(|n| n.decimals > 0);
    let moved = [10.0, 0.1, 100.0, 0.01].map(|f| value * f);
    let has_point = |v: &f64| pointed || (v - v.round()).abs() > 1e-9;
    candidates.extend(moved.into_iter().filter(has_point).map(|v| (Slip::Point, v)));
    if let Some(n) = &number {
        candidates.extend(n.doubled().map(|v| (Slip::Doubled, v)));
        candidates.extend(n.left_out().map(|v| (Slip::LeftOut, v)));
        candidates.extend(n.replaced().map(|v| (Slip::Digit, v)));
    }
    let explains =
        |meant: f64| (meant - fits).abs() <= tolerance && tolerance <= 0.25 * (meant - value).abs();
    let found = candidates.iter().find(|(_, meant)| explains(*meant))?;
    // Of one kind of slip the nearest.
    candidates
        .iter()
        .filter(|(slip, meant)| *slip == found.0 && explains(*meant))
        .min_by(|a, b| (a.1 - fits).abs().total_cmp(&(b.1 - fits).abs()))
        .map(|(slip, meant)| (*slip, (meant * 1e6).round() / 1e6))
}

/// Where a neighbour's number is typed again: the one between both neighbours, and the next step.
fn not_advanced(value: f64, [before, after]: [&[f64]; 2]) -> Vec<f64> {
    let same = |list: &[f64]| list.first().is_some_and(|v| (v - value).abs() < 1e-9);
    let mut meant = Vec::new();
    for (side, other) in [(before, after), (after, before)] {
        if same(side) {
            meant.extend(other.first().map(|o| 0.5 * (value + o)));
            meant.extend(side.get(1).map(|beyond| 2.0 * value - beyond));
        }
    }
    meant
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_told_apart() {
        for (typed, before, after, fits, slip, meant) in [
            ("12", 20.0, 22.0, 21.02, Slip::Transposed, 21.0),
            ("12", -13.0, -11.0, -12.01, Slip::Sign, -12.0),
            ("125", 10.0, 15.0, 12.51, Slip::Point, 12.5),
            ("1.25", 10.0, 15.0, 12.49, Slip::Point, 12.5),
            ("1,25", 10.0, 15.0, 12.49, Slip::Point, 12.5),
            ("-122", -11.0, -13.0, -12.0, Slip::Doubled, -12.0),
            ("1", 11.0, 13.0, 12.03, Slip::LeftOut, 12.0),
            ("1.5", 11.0, 13.0, 12.48, Slip::LeftOut, 12.5),
            ("42", 11.0, 13.0, 12.0, Slip::Digit, 12.0),
            ("11", 11.0, 13.0, 12.0, Slip::NotAdvanced, 12.0),
        ] {
            let value: f64 = typed.replace(',', ".").parse().unwrap();
            let found = explain(typed, value, [&[before], &[after]], fits, 0.1);
            assert_eq!(found, Some((slip, meant)), "{typed}");
        }
        // Half a degree between the lines of a dial is no slip.
        assert_eq!(explain("12", 12.0, [&[11.0], &[13.0]], 14.6, 0.1), None);
        // Nothing is explained where hardly anything is known.
        assert_eq!(explain("12", 12.0, [&[11.0], &[13.0]], 13.0, 0.9), None);
    }
}
