//! A log of forces, and its reading from CSV.

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::number_columns::NumberColumns;

/// Maximum number of rows of a log. With forces alone a row takes 36 bytes (720 MB for all of them), with moments 60
/// (1.2 GB), as much again while it is conditioned.
pub(crate) const MOST_ROWS: usize = 20_000_000;

/// Names of the channels, in their order.
pub(crate) const CHANNELS: [&str; 6] = ["fx_n", "fy_n", "fz_n", "mx_n_m", "my_n_m", "mz_n_m"];

/// Abscissa of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoggedBy {
    /// Time, s.
    Time,
    /// Length of the path along its feed moves, mm.
    AlongPath,
}

impl LoggedBy {
    /// Name of its column.
    ///
    /// ```
    /// assert_eq!(kinetostat_cutting::LoggedBy::Time.column(), "time_s");
    /// ```
    #[must_use]
    pub fn column(self) -> &'static str {
        match self {
            Self::Time => "time_s",
            Self::AlongPath => "along_mm",
        }
    }

    /// Unit of it.
    ///
    /// ```
    /// assert_eq!(kinetostat_cutting::LoggedBy::AlongPath.unit(), "mm");
    /// ```
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::AlongPath => "mm",
        }
    }
}

/// Forces (N) and moments (N m) over time (s) or along a path (mm), in the axes and with the sign in which they were logged.
///
/// ```
/// use kinetostat_cutting::{ForceLog, LoggedBy};
///
/// let text = "# 1 kHz, on the spindle\ntime_s;fx_n;fy_n;fz_n\n0.000;1;0;0\n0.001;3;0;0\n0.003;3;4;0\n";
/// let log = ForceLog::read("slot.csv", text)?;
/// assert_eq!(log.by(), LoggedBy::Time);
/// assert_eq!((log.rows(), log.range()), (3, [0.0, 0.003]));
/// assert_eq!(log.spacing(), 0.0015);
/// let (force_n, moment_n_m) = log.at(0.002).unwrap();
/// assert_eq!((force_n, moment_n_m), ([3.0, 2.0, 0.0], [0.0; 3]));
/// assert_eq!(log.at(0.004), None);
/// assert_eq!(log.rows_between(0.0005, 0.002), [0.001]);
///
/// let forces = [vec![1.0, 3.0, 3.0], vec![0.0, 0.0, 4.0], vec![0.0; 3]];
/// let same = ForceLog::new(LoggedBy::Time, vec![0.0, 0.001, 0.003], forces, None)?;
/// assert_eq!(same.at(0.002), log.at(0.002));
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ForceLog {
    pub(crate) by: LoggedBy,
    pub(crate) at: Vec<f64>,
    /// Three forces, or three forces and three moments.
    pub(crate) channels: Vec<Vec<f64>>,
    /// Lines of the rows in the file; none where it was read from none.
    pub(crate) lines: Vec<u32>,
}

impl ForceLog {
    /// A log of rows at these times or lengths, with a list of each component.
    ///
    /// # Errors
    /// Lists of different lengths, fewer than two rows, more than 20 million, times that do not increase, numbers beyond any
    /// dynamometer (1e9 s or mm, 1e6 N or N m).
    pub fn new(
        by: LoggedBy,
        at: Vec<f64>,
        force_n: [Vec<f64>; 3],
        moment_n_m: Option<[Vec<f64>; 3]>,
    ) -> Result<Self> {
        let channels: Vec<Vec<f64>> = force_n
            .into_iter()
            .chain(moment_n_m.into_iter().flatten())
            .collect();
        if let Some(other) = channels.iter().find(|channel| channel.len() != at.len()) {
            return Err(CutError::new(
                CutErrorKind::Measurement,
                "rows",
                format!("{} times and {} values", at.len(), other.len()),
                "as many values as times",
            ));
        }
        most_rows(at.len())?;
        for (row, place) in at.iter().enumerate() {
            in_order(by, row.checked_sub(1).map(|before| at[before]), *place)?;
            for (name, channel) in CHANNELS.iter().zip(&channels) {
                possible(name, channel[row])?;
            }
        }
        two_rows(at.len())?;
        let lines = Vec::new();
        Ok(Self {
            by,
            at,
            channels,
            lines,
        })
    }

    /// Abscissa of the log.
    #[must_use]
    pub fn by(&self) -> LoggedBy {
        self.by
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.at.len()
    }

    /// Time or length of the first row and of the last, s or mm.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        match self.at.as_slice() {
            [first, .., last] => [*first, *last],
            _ => [0.0; 2],
        }
    }

    /// Mean time or length from row to row, s or mm.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        let [from, to] = self.range();
        (to - from) / (self.rows() - 1) as f64
    }

    /// Times or lengths of the rows from one place to another, s or mm: between them the log is straight.
    #[must_use]
    pub fn rows_between(&self, from: f64, to: f64) -> &[f64] {
        let first = self.at.partition_point(|at| *at < from);
        let end = self.at.partition_point(|at| *at <= to);
        self.at.get(first..end).unwrap_or_default()
    }

    /// Force (N) and moment (N m; zero without columns of moments) at a time or length, on straight lines between the rows;
    /// `None` before the first and after the last.
    #[must_use]
    pub fn at(&self, at: f64) -> Option<([f64; 3], [f64; 3])> {
        let [from, to] = self.range();
        if !(from..=to).contains(&at) {
            return None;
        }
        let after = self.at.partition_point(|place| *place <= at);
        let after = after.clamp(1, self.at.len() - 1);
        let (a, b) = (self.at[after - 1], self.at[after]);
        let part = (at - a) / (b - a);
        let value = |channel: usize| {
            self.channels.get(channel).map_or(0.0, |values| {
                let (before, next) = (values[after - 1], values[after]);
                before + part * (next - before)
            })
        };
        Some(([0, 1, 2].map(value), [3, 4, 5].map(value)))
    }

    /// Size of the force in each row, N.
    pub(crate) fn sizes(&self) -> Vec<f64> {
        let [x, y, z] = [0, 1, 2].map(|i| &self.channels[i]);
        let components = x.iter().zip(y).zip(z);
        components
            .map(|((x, y), z)| (x * x + y * y + z * z).sqrt())
            .collect()
    }

    /// Names and values of its channels.
    pub(crate) fn named(&self) -> impl Iterator<Item = (&'static str, &Vec<f64>)> {
        CHANNELS.into_iter().zip(&self.channels)
    }

    /// Line of a row (from 0) in the file, if it was read from one.
    pub(crate) fn line(&self, row: usize) -> Option<usize> {
        self.lines.get(row).map(|line| *line as usize)
    }
}

pub(crate) fn most_rows(count: usize) -> Result<()> {
    match count <= MOST_ROWS {
        true => Ok(()),
        false => Err(CutError::new(
            CutErrorKind::Measurement,
            "rows",
            format!("{count} or more"),
            format!("at most {MOST_ROWS}: log more slowly, or the part of interest"),
        )),
    }
}

pub(crate) fn two_rows(count: usize) -> Result<()> {
    match count >= 2 {
        true => Ok(()),
        false => Err(CutError::new(
            CutErrorKind::Measurement,
            "rows",
            count,
            "two at least",
        )),
    }
}

/// Rows come one after the other.
pub(crate) fn in_order(by: LoggedBy, before: Option<f64>, at: f64) -> Result<()> {
    let kind = CutErrorKind::Measurement;
    within(kind, by.column(), at, -1e9..=1e9, by.unit())?;
    match before {
        Some(before) if at <= before => Err(CutError::new(
            kind,
            by.column(),
            format!("{at} {unit} after {before} {unit}", unit = by.unit()),
            "every row later than the one before",
        )),
        _ => Ok(()),
    }
}

pub(crate) fn possible(channel: &str, value: f64) -> Result<()> {
    let unit = match channel.starts_with('f') {
        true => "N",
        false => "N m",
    };
    within(CutErrorKind::Measurement, channel, value, -1e6..=1e6, unit).map(drop)
}

const COLUMNS: [&str; 8] = [
    "time_s", "along_mm", "fx_n", "fy_n", "fz_n", "mx_n_m", "my_n_m", "mz_n_m",
];

impl ForceLog {
    /// A log from CSV with commas or semicolons: a column `time_s`, or `along_mm` (length along the feed moves of the program),
    /// `fx_n`, `fy_n`, `fz_n`, and `mx_n_m`, `my_n_m`, `mz_n_m` where moments were measured; in any order. Lines that begin with
    /// `#` are passed over.
    ///
    /// ```
    /// use kinetostat_cutting::ForceLog;
    ///
    /// let text = "time_s,fx_n,fy_n,fz_n\n0,1,2,3\n# a pause\n0,1,2,3\n";
    /// let error = ForceLog::read("slot.csv", text).unwrap_err();
    /// assert_eq!(error.to_string(), "slot.csv:4: time_s: 0 s after 0 s; expected every row later than the one before");
    /// ```
    ///
    /// # Errors
    /// With file and line: no header, columns that are unknown, missing or there twice, cells that are no numbers, rows of
    /// another length, and as [`ForceLog::new`].
    pub fn read(name_of_file: &str, text: &str) -> Result<Self> {
        let columns = NumberColumns { known: &COLUMNS };
        let mut found = None;
        let (mut at, mut lines) = (Vec::new(), Vec::new());
        let mut channels = vec![Vec::new(); CHANNELS.len()];
        let note = |there: &[bool]| {
            found = Some(Found::of(there)?);
            Ok(())
        };
        let mut by = LoggedBy::Time;
        let last = columns.read(name_of_file, text, note, |cells, line| {
            most_rows(at.len() + 1)?;
            let place = match (cells[0], cells[1]) {
                (Some(time), _) => time,
                (None, along) => {
                    by = LoggedBy::AlongPath;
                    along.unwrap_or(f64::NAN)
                }
            };
            in_order(by, at.last().copied(), place)?;
            at.push(place);
            lines.push(u32::try_from(line).unwrap_or(u32::MAX));
            for ((channel, name), cell) in channels.iter_mut().zip(CHANNELS).zip(&cells[2..]) {
                if let Some(value) = *cell {
                    possible(name, value)?;
                    channel.push(value);
                }
            }
            Ok(())
        })?;
        two_rows(at.len()).map_err(|error| error.at(name_of_file, Some(last)))?;
        if found == Some(Found::Forces) {
            channels.truncate(3);
        }
        Ok(Self {
            by,
            at,
            channels,
            lines,
        })
    }
}

/// Channels of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Found {
    Forces,
    ForcesAndMoments,
}

impl Found {
    fn of(there: &[bool]) -> std::result::Result<Self, String> {
        match (there[0], there[1]) {
            (true, true) => {
                return Err("`time_s` and `along_mm`, of which one is needed".to_owned());
            }
            (false, false) => return Err("neither `time_s` nor `along_mm`".to_owned()),
            _ => {}
        }
        let missing = |from: usize, to: usize| {
            let mut columns = (from..to).filter(|i| !there[*i]);
            columns
                .next()
                .map(|i| format!("no column `{}`", COLUMNS[i]))
        };
        if let Some(missing) = missing(2, 5) {
            return Err(missing);
        }
        match (there[5..].contains(&true), missing(5, 8)) {
            (false, _) => Ok(Self::Forces),
            (true, None) => Ok(Self::ForcesAndMoments),
            (true, Some(missing)) => Err(missing),
        }
    }
}
