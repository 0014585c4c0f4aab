//! A log from CSV.

use crate::error::Result;
use crate::measured::log::{CHANNELS, ForceLog, LoggedBy, in_order, most_rows, possible, two_rows};
use crate::number_columns::NumberColumns;

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
