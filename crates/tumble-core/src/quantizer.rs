//! What the converter does to the analogue value.

pub use tumble_runtime::{Compensation, Nonlinearity, QuantizerOffset};

use crate::Code;

/// How a converter turns an analogue value `x` (in LSB) into a code.
///
/// **Source** method section 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantizer {
    /// Toward zero: `n > 0` stands for `[n, n+1)`, `n < 0` for `(n−1, n]`, `0` for `(−1, 1)`.
    Truncate,
    /// Down: `[n, n+1)`.
    Floor,
    /// To nearest: `[n−½, n+½)`.
    Round,
    /// Not quantized: readings are real numbers in a unit of their own.
    None,
}

impl Quantizer {
    /// The offset that compensates it.
    #[must_use]
    pub fn offset(self) -> QuantizerOffset {
        match self {
            Self::Truncate => QuantizerOffset::HalfSign,
            Self::Floor => QuantizerOffset::Half,
            Self::Round | Self::None => QuantizerOffset::None,
        }
    }

    /// `N* = N̂ + c(N̂)`: the analogue value that a mean of codes stands for, LSB.
    ///
    /// **Assumes** that the noise spreads over at least half an LSB, and for [`Quantizer::Truncate`] that the
    /// mean stays away from zero (`|N̂| > 1 + 4σ`); nearer to zero the sign rule is off by up to 0.5 LSB.
    #[must_use]
    pub fn analogue_lsb(self, mean_code: f64) -> f64 {
        mean_code + self.offset().lsb(mean_code)
    }

    /// The code of an analogue value, before the converter's ends; `None` for [`Quantizer::None`] or outside
    /// of the integers that a code can hold.
    #[must_use]
    pub fn code(self, analogue_lsb: f64) -> Option<Code> {
        let n = match self {
            Self::Truncate => analogue_lsb.trunc(),
            Self::Floor => analogue_lsb.floor(),
            Self::Round => (analogue_lsb + 0.5).floor(),
            Self::None => return None,
        };
        (n >= f64::from(i32::MIN) && n <= f64::from(i32::MAX)).then_some(Code(n as i32))
    }

    /// The interval of analogue values (LSB) that a code stands for.
    #[must_use]
    pub fn interval_lsb(self, code: Code) -> (f64, f64) {
        let n = f64::from(code.0);
        match self {
            Self::Truncate if code.0 > 0 => (n, n + 1.0),
            Self::Truncate if code.0 < 0 => (n - 1.0, n),
            Self::Truncate => (-1.0, 1.0),
            Self::Floor => (n, n + 1.0),
            Self::Round => (n - 0.5, n + 0.5),
            Self::None => (n, n),
        }
    }
}

/// The ends of the converter. A code at an end stands for a half-line: it is censored, never averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ConverterEnds {
    /// Lowest code.
    pub min_code: Option<Code>,
    /// Highest code.
    pub max_code: Option<Code>,
}

impl ConverterEnds {
    /// Whether a code stands at or beyond an end.
    #[must_use]
    pub fn censors(&self, code: Code) -> bool {
        self.min_code.is_some_and(|m| code <= m) || self.max_code.is_some_and(|m| code >= m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_code_stands_for_the_interval_that_it_came_from() {
        for q in [Quantizer::Truncate, Quantizer::Floor, Quantizer::Round] {
            for i in -4000..4000 {
                let x = f64::from(i) * 0.001_7;
                let code = q.code(x).unwrap();
                let (lo, hi) = q.interval_lsb(code);
                assert!(lo <= x && x <= hi, "{q:?}: {x} gave {code:?} = [{lo}, {hi}]");
            }
        }
    }

    #[test]
    fn sign_rule_of_a_truncating_converter() {
        assert_eq!(Quantizer::Truncate.analogue_lsb(-3.25), -3.75);
        assert_eq!(Quantizer::Truncate.analogue_lsb(3.25), 3.75);
        assert_eq!(Quantizer::Truncate.analogue_lsb(0.0), 0.0);
        assert_eq!(Quantizer::Floor.analogue_lsb(-3.25), -2.75);
        assert_eq!(Quantizer::Round.analogue_lsb(-3.25), -3.25);
    }

    #[test]
    fn codes_beyond_the_integers_are_refused() {
        assert_eq!(Quantizer::Floor.code(1e12), None);
        assert_eq!(Quantizer::Floor.code(f64::NAN), None);
        assert_eq!(Quantizer::None.code(1.0), None);
    }
}
