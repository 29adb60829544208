//! A look at the beginning of a file: separator, header, first line of data.
//!
//! Nothing is read by it. It proposes: to `tumble init`, and in errors about a header that stands elsewhere.

use std::io::Read as _;
use std::path::Path;

use super::clock::date_s;
use super::dial::dms;
use super::dialect::Delimiter;
use super::header::{decoded, names};
use super::number::{CodeFormat, DecimalSign, has_thousands, real, says_missing, trimmed};
use super::roles::{HeaderUnit, role, split_unit};
use super::row::FieldBuffer;
use super::run_file::RunFileOptions;
use crate::error::{Place, Problem, ReadError};
use crate::source::Source;

/// Bytes that are looked at.
const LOOK: u64 = 64 << 10;
/// Lines that are looked at.
const LINES: usize = 400;
/// Marks of comments that are no `#`.
const COMMENTS: [&str; 4] = ["%", "//", "!", "*"];

/// How a file seems to be written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sketch {
    pub(crate) delimiter: Delimiter,
    /// Numbers have decimal commas.
    pub(crate) decimal_comma: bool,
    /// Line of the header; 0 where there is none.
    pub(crate) header_line: u64,
    /// The header is the first line that is neither blank nor a comment.
    pub(crate) header_is_first: bool,
    /// Names of the columns, as the reader will call them.
    pub(crate) names: Vec<String>,
    /// Units of the columns, by the header or the line under it.
    pub(crate) units: Vec<Option<HeaderUnit>>,
    /// First line of data.
    pub(crate) data_line: u64,
    /// Data follow at once upon the header.
    pub(crate) data_is_next: bool,
    /// Names in the line above the data, where they are fewer than the numbers of each row.
    pub(crate) narrow_header: Option<usize>,
    /// The first row of data.
    pub(crate) first_row: String,
    /// What comments among the data begin with, where it is no `#`.
    pub(crate) comment: Option<&'static str>,
}

impl Sketch {
    /// How numbers seem to be written.
    pub(crate) fn decimal(&self) -> DecimalSign {
        if self.decimal_comma { DecimalSign::CommaOrPoint } else { self.delimiter.decimal() }
    }
}

/// Looks at the beginning of a file.
pub(crate) fn sketch_file(path: &Path, shown_as: &str) -> Result<Option<Sketch>, ReadError> {
    let mut head = Vec::new();
    let mut source = Source::open(path, shown_as)?.take(LOOK);
    source
        .read_to_end(&mut head)
        .map_err(|e| ReadError { place: Place::file(shown_as), problem: Source::problem(e) })?;
    if head.contains(&0) {
        let problem = Problem::Format { seen: "binary data", remedy: "give a CSV file" };
        return Err(ReadError { place: Place::file(shown_as), problem });
    }
    // The last line may be cut.
    if head.len() as u64 == LOOK {
        let end = memchr::memrchr(b'\n', &head).map_or(head.len(), |i| i + 1);
        head.truncate(end);
    }
    Ok(sketch(&head))
}

/// Looks at the beginning of a text. `None` where nothing looks like rows of numbers.
pub(crate) fn sketch(head: &[u8]) -> Option<Sketch> {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let lines: Vec<String> = head
        .split(|b| *b == b'\n')
        .take(LINES)
        .map(|l| decoded(l.strip_suffix(b"\r").unwrap_or(l)))
        .collect();
    let candidates =
        [b';', b'\t', b'|', b','].map(Delimiter::Byte).into_iter().chain([Delimiter::Blanks]);
    let mut best: Option<(f64, Delimiter, usize, usize)> = None;
    for delimiter in candidates {
        let Some((score, first, width)) = block_of_data(&lines, delimiter) else { continue };
        if best.as_ref().is_none_or(|b| score > b.0 * 1.000_001) {
            best = Some((score, delimiter, first, width));
        }
    }
    let (_, delimiter, first, width) = best?;
    let delimiter = if width == 1 { Delimiter::Byte(b',') } else { delimiter };
    Some(around(&lines, delimiter, first, width))
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

fn fields(line: &str, delimiter: Delimiter) -> Vec<String> {
    let mut found = names(line, delimiter);
    while found.len() > 1 && found.last().is_some_and(String::is_empty) {
        found.pop();
    }
    found
}

/// Whether a field can stand in a row of data, other than as a word.
fn is_number(field: &str) -> bool {
    let bytes = field.as_bytes();
    // Between commas, a comma in a field stood in quotes.
    let decimal = DecimalSign::CommaOrPoint;
    let hex = CodeFormat { hexadecimal: true, bits: None, offset: 0 };
    real(bytes, decimal).is_some()
        || date_s(bytes).is_some()
        || dms(bytes, decimal).is_some()
        || (field.bytes().any(|b| b.is_ascii_digit()) && hex.code(bytes).is_some())
}

/// A row that can be data.
struct DataRow {
    /// Fields up to the last one that holds something, and all of them: empty ones at the end may be cells, or nothing.
    filled: usize,
    all: usize,
    /// The share of the fields that are numbers.
    share: f64,
}

fn data_row(line: &str, delimiter: Delimiter) -> Option<DataRow> {
    let all = names(line, delimiter).len();
    let fields = fields(line, delimiter);
    let numbers = fields.iter().filter(|f| is_number(f)).count();
    let known = numbers + fields.iter().filter(|f| says_missing(f.as_bytes())).count();
    let share = known as f64 / fields.len() as f64;
    (numbers > 0 && share >= 0.5).then_some(DataRow { filled: fields.len(), all, share })
}

/// Rows of one width on end.
#[derive(Clone, Copy)]
struct Block {
    score: f64,
    rows: usize,
    /// First line, from zero.
    first: usize,
    width: usize,
    /// Fields that every row has, filled or not.
    fewest: usize,
}

impl Block {
    fn of(row: &DataRow, line: usize) -> Self {
        let score = row.share * row.share;
        Self { score, rows: 1, first: line, width: row.filled, fewest: row.all }
    }

    /// The block with one more row, where the row fits.
    fn with(self, row: &DataRow) -> Option<Self> {
        let (width, fewest) = (self.width.max(row.filled), self.fewest.min(row.all));
        (width <= fewest).then_some(Self {
            score: self.score + row.share * row.share,
            rows: self.rows + 1,
            width,
            fewest,
            ..self
        })
    }

    /// One column of numbers is what every separator finds; more columns tell more.
    fn weight(&self) -> f64 {
        if self.width > 1 { self.score } else { 0.5 * self.score }
    }

    fn mean_score(&self) -> f64 {
        self.score / self.rows as f64
    }
}

/// The longest block of rows of one width: its weight, first line (from zero) and width.
///
/// Where rows of just that kind stand above it, under a header, something stands among the data: they begin there, and
/// reading them will tell what it is.
fn block_of_data(lines: &[String], delimiter: Delimiter) -> Option<(f64, usize, usize)> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for (i, line) in lines.iter().enumerate() {
        let foreign = COMMENTS.iter().any(|c| line.trim_start().starts_with(c));
        if line.trim().is_empty() || is_comment(line) || foreign {
            continue;
        }
        let Some(row) = data_row(line, delimiter) else {
            open = false;
            continue;
        };
        match blocks.last_mut().filter(|_| open).and_then(|b| Some((b.with(&row)?, b))) {
            Some((longer, last)) => *last = longer,
            None => blocks.push(Block::of(&row, i)),
        }
        open = true;
    }
    let best = *blocks.iter().reduce(|a, b| if b.weight() > a.weight() { b } else { a })?;
    let alike = |b: &&Block| {
        b.width == best.width
            && b.mean_score() >= best.mean_score() - 0.01
            && !headers_above(lines, delimiter, b.first, b.width).is_empty()
    };
    let first = blocks.iter().find(alike).map_or(best.first, |b| b.first.min(best.first));
    Some((best.weight(), first, best.width))
}

/// A header without the mark of a comment in front of it.
fn uncommented(line: &str) -> &str {
    line.trim_start().trim_start_matches(['#', '%', '!', '*', '/']).trim()
}

/// Lines right above a first row that can be its header: as many words as columns.
fn headers_above(lines: &[String], delimiter: Delimiter, first: usize, width: usize) -> Vec<usize> {
    (0..first)
        .rev()
        .filter(|i| !lines[*i].trim().is_empty())
        .take(3)
        .filter(|i| {
            let found = fields(uncommented(&lines[*i]), delimiter);
            let words = found.iter().filter(|f| !is_number(f)).count();
            let fits = found.len() == width;
            fits && words * 2 > found.len() && !(width == 1 && is_prose(&lines[*i]))
        })
        .collect()
}

/// The header above a block of data, and what else is worth knowing.
fn around(lines: &[String], delimiter: Delimiter, first: usize, width: usize) -> Sketch {
    let above = headers_above(lines, delimiter, first, width);
    let is_units = |i: &usize| {
        let found = fields(uncommented(&lines[*i]), delimiter);
        found.iter().all(|f| {
            let bare = f.trim_matches(['[', ']', '(', ')', '-', ' ']);
            bare.is_empty() || split_unit(&format!("x [{bare}]")).1.is_some()
        })
    };
    let (header, units_row) = match above[..] {
        [units, header, ..] if is_units(&units) && !is_units(&header) => {
            (Some(header), Some(units))
        }
        [header, ..] => (Some(header), None),
        [] => (None, None),
    };
    let names: Vec<String> = match header {
        Some(i) => fields(uncommented(&lines[i]), delimiter),
        None => (1..=width).map(|n| format!("column {n}")).collect(),
    };
    let under: Vec<String> =
        units_row.map_or_else(Vec::new, |i| fields(uncommented(&lines[i]), delimiter));
    let units = (0..width)
        .map(|i| {
            let own = names.get(i).and_then(|n| split_unit(n).1);
            let below = under.get(i).map(|u| u.trim_matches(['[', ']', '(', ')', ' ']));
            own.or_else(|| below.and_then(|u| split_unit(&format!("x [{u}]")).1))
        })
        .collect();
    let plain = |l: &String| !l.trim().is_empty() && !is_comment(l);
    let first_plain = lines.iter().position(plain);
    let next_plain = header.and_then(|h| (h + 1..lines.len()).find(|i| plain(&lines[*i])));
    // Words between commas, and more fields under them: numbers with decimal commas make such rows.
    let narrow = above.is_empty().then(|| first.checked_sub(1)).flatten().filter(|i| {
        let found = fields(&lines[*i], delimiter);
        delimiter == Delimiter::Byte(b',')
            && (2..width).contains(&found.len())
            && found.iter().all(|f| !is_number(f) && f.chars().any(char::is_alphabetic))
    });
    let rows = || lines[first..].iter().filter(|l| plain(l));
    Sketch {
        delimiter,
        decimal_comma: rows().any(|l| has_decimal_comma(l, delimiter)),
        header_line: header.map_or(0, |i| i as u64 + 1),
        header_is_first: header.is_some() && header == first_plain,
        names,
        units,
        data_line: first as u64 + 1,
        data_is_next: next_plain == Some(first),
        narrow_header: narrow.map(|i| fields(&lines[i], delimiter).len()),
        first_row: lines[first].clone(),
        comment: COMMENTS.into_iter().find(|c| rows().any(|l| l.trim_start().starts_with(c))),
    }
}

/// A sentence is no header of one column.
fn is_prose(line: &str) -> bool {
    role(line).is_none() && line.split_whitespace().count() > 2
}

fn has_decimal_comma(line: &str, delimiter: Delimiter) -> bool {
    let mut buffer = FieldBuffer::default();
    let found = buffer.split(line.as_bytes(), delimiter);
    (0..found.len()).any(|i| {
        let field = trimmed(found.get(i));
        // Between commas it stands in quotes, and `"1,108"` is a thousand there.
        let thousands = delimiter == Delimiter::Byte(b',') && has_thousands(field);
        field.contains(&b',') && real(field, DecimalSign::CommaOrPoint).is_some() && !thousands
    })
}

/// Adds to an error about a header what a look at the file tells.
pub(crate) fn with_advice(e: ReadError, path: &Path, options: &RunFileOptions<'_>) -> ReadError {
    let about_header = matches!(
        e.problem,
        Problem::Columns { .. }
            | Problem::NoHeader { .. }
            | Problem::Fields { .. }
            | Problem::Field { .. }
    );
    let dialect = options.dialect;
    if !about_header || dialect.header_line.is_some() {
        return e;
    }
    let Ok(Some(seen)) = sketch_file(path, &e.place.file) else { return e };
    let here = e.place.line.unwrap_or(1);
    if here > seen.data_line {
        return e;
    }
    let mut write = Vec::new();
    if seen.header_line > 0 && !seen.header_is_first {
        write.push(format!("header_line = {}", seen.header_line));
    }
    if seen.header_line > 0 && !seen.data_is_next && dialect.data_line.is_none() {
        write.push(format!("data_line = {}", seen.data_line));
    }
    if seen.delimiter == Delimiter::Blanks && dialect.delimiter.is_none() {
        write.push("delimiter = \"blanks\"".to_owned());
    }
    if write.is_empty() {
        return e;
    }
    let what = if seen.header_line > 0 {
        format!(
            "Line {} looks like the header and line {} like the first data",
            seen.header_line, seen.data_line
        )
    } else {
        format!(
            "Line {} looks like the first data, with blanks between the numbers",
            seen.data_line
        )
    };
    let advice = format!("{what}: write {} in [csv]", write.join(", "));
    ReadError { place: e.place, problem: Problem::Advised { problem: Box::new(e.problem), advice } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(text: &str) -> Sketch {
        sketch(text.as_bytes()).unwrap()
    }

    #[test]
    fn plain_files() {
        let s = seen("angle_deg,code\n-30,10\n-30,12\n");
        assert_eq!((s.delimiter, s.header_line, s.data_line), (Delimiter::Byte(b','), 1, 2));
        assert!(s.header_is_first && s.data_is_next && !s.decimal_comma);
        let s = seen("Winkel [°];ADC\r\n-30,5;10\r\n-30,5;12\r\n");
        assert_eq!(s.names, ["Winkel [°]", "ADC"]);
        assert!(s.decimal_comma && s.delimiter == Delimiter::Byte(b';'));
        assert_eq!(s.units[0], Some(HeaderUnit::Degrees));
    }

    #[test]
    fn headers_that_stand_elsewhere() {
        let s = seen(
            "Logger 3000\nOperator: me, myself\nDate: today\n\nAngle,ADC\n[deg],[LSB]\n0,1\n0,2\n5,3\n",
        );
        assert_eq!((s.header_line, s.data_line), (5, 7));
        assert!(!s.header_is_first && !s.data_is_next);
        assert_eq!(s.units, [Some(HeaderUnit::Degrees), Some(HeaderUnit::Lsb)]);
        let s = seen("# angle code\n0 1\n0 2\n  5   3\n");
        assert_eq!((s.delimiter, s.header_line), (Delimiter::Blanks, 1));
        assert_eq!(s.names, ["angle", "code"]);
    }

    #[test]
    fn no_header_and_no_data() {
        let s = seen("  2.5450002e+005 -3.13e-003  9.93\n  2.5450003e+005  1.6e-003  9.7\n");
        assert_eq!((s.header_line, s.names.len(), s.data_line), (0, 3, 1));
        assert_eq!(seen("12\n13\n12\n").names, ["column 1"]);
        assert_eq!(seen("code\n12\n13\n12\n").names, ["code"]);
        assert!(sketch(b"nothing here\nbut words\n").is_none());
        assert!(sketch(b"").is_none());
    }

    #[test]
    fn odd_rows_move_no_beginning() {
        // Empty cells at the end of a row make it no narrower.
        let s = seen("a,b\n0,1\n0,\n0,1\n0,2\n0,3\n");
        assert_eq!((s.header_line, s.data_line, s.names.len()), (1, 2, 2));
        let s = seen("a,b\n0,\n0,1\n0,2\n");
        assert_eq!((s.header_line, s.data_line, s.names.len()), (1, 2, 2));
        // A row that is none stands among the data; what is above it is data, too.
        let s = seen("a,b\n0,1\n0,2\nmoved\n5,1\n5,2\n5,3\n");
        assert_eq!((s.header_line, s.data_line), (1, 2));
        let s = seen("Logger;3\nSerial;17\na;b\n5;1\n5;2\n5;3\n");
        assert_eq!((s.header_line, s.data_line), (3, 4));
        let s = seen("angle,code\n-30,5,100\n-30,5,101\n");
        assert_eq!((s.header_line, s.narrow_header), (0, Some(2)));
    }

    #[test]
    fn words_and_gaps_among_the_data() {
        let s =
            seen("time,sensor,angle,raw\n10:15:30,A7,0,12\n10:15:31,A7,0,NaN\n10:15:32,B2,5,\n");
        assert_eq!((s.header_line, s.names.len()), (1, 4));
        let s = seen("angle\tcode\n% moved\n0\t1\n% again\n5\t2\n");
        assert_eq!((s.comment, s.header_line), (Some("%"), 1));
    }
}
