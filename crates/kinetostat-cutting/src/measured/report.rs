//! Record of a log's conditioning, in words.

use crate::measured::cleaning::{DriftRemoved, FEWEST_ROWS, Outlier, SIDE, SPREADS};
use crate::measured::log::{CHANNELS, LoggedBy};

/// Record of a log's conditioning.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ConditioningReport {
    /// Abscissa of the log.
    pub by: LoggedBy,
    /// Rows of the log.
    pub rows: usize,
    /// Channels: three forces, with moments six.
    pub channels: usize,
    /// Values that were replaced by the median of the rows around them: the first thousand, by channel and row.
    pub outliers: Vec<Outlier>,
    /// Number of outliers.
    pub outlier_count: usize,
    /// The one farthest from its median.
    pub worst_outlier: Option<Outlier>,
    /// True if outliers were searched for.
    pub outliers_looked_for: bool,
    /// Drift that was removed; `None` where no air was stated.
    pub drift: Option<DriftRemoved>,
    /// Window of the moving mean, s or mm; 0 without.
    pub window: f64,
    /// Mean from row to row, s or mm.
    pub spacing: f64,
    /// The longest step from row to row: where it begins, and its length, s or mm.
    pub longest_step: [f64; 2],
}

impl ConditioningReport {
    /// Describes the steps in their order, one sentence each.
    ///
    /// ```
    /// use kinetostat_cutting::{Conditioning, ForceLog};
    ///
    /// let text = "time_s,fx_n,fy_n,fz_n\n0,10,0,0\n1,10,0,0\n2,12,0,0\n";
    /// let done = Conditioning::new(0.5).apply(&ForceLog::read("short.csv", text)?)?;
    /// assert!(done.report.sentences()[1].starts_with("drift: none removed"));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        vec![self.of_outliers(), self.of_drift(), self.of_smoothing()]
    }

    fn of_outliers(&self) -> String {
        if self.rows < FEWEST_ROWS {
            return format!("outliers: not looked for in fewer than {FEWEST_ROWS} rows");
        }
        if !self.outliers_looked_for {
            return "outliers: not looked for, as stated".to_owned();
        }
        let filter = format!(
            "Hampel filter, {} rows, {SPREADS} scaled median deviations",
            2 * SIDE + 1
        );
        match &self.worst_outlier {
            None => format!("outliers: none ({filter})"),
            Some(worst) => format!(
                "outliers: {} of {} values replaced by the median around them ({filter}); the worst: {}",
                self.outlier_count,
                self.channels * self.rows,
                self.of_outlier(worst)
            ),
        }
    }

    /// An outlier in words.
    fn of_outlier(&self, outlier: &Outlier) -> String {
        let unit = match outlier.channel.starts_with('f') {
            true => "N",
            false => "N m",
        };
        let place = match outlier.line {
            Some(line) => format!("line {line}"),
            None => format!("row {}", outlier.row),
        };
        format!(
            "{} = {} {unit} on {place}, at {} {}, among {} {unit}",
            outlier.channel,
            outlier.value,
            outlier.at,
            self.by.unit(),
            outlier.median
        )
    }

    fn of_drift(&self) -> String {
        let Some(drift) = &self.drift else {
            return "drift: none removed, for no time is stated at which the tool is in air"
                .to_owned();
        };
        let ends = drift.at_start.iter().zip(&drift.at_end).zip(CHANNELS);
        let channels: Vec<String> = ends
            .map(|((start, end), name)| format!("{name} {start:.3} to {end:.3}"))
            .collect();
        let of = match drift.stretches {
            1 => "the mean of one stretch in air".to_owned(),
            n => format!("straight lines through {n} stretches in air"),
        };
        format!(
            "drift: {of} removed, from the beginning of the log to its end {}; at most {:.3} N are left in air",
            channels.join(", "),
            drift.left_n
        )
    }

    fn of_smoothing(&self) -> String {
        let unit = self.by.unit();
        match self.window > 0.0 {
            true => format!(
                "smoothing: mean over {} {unit} around each row (shorter at the ends of the log)",
                significant(self.window)
            ),
            false => "smoothing: none".to_owned(),
        }
    }

    /// The worst outlier in words, where there is one.
    ///
    /// ```
    /// use kinetostat_cutting::{Conditioning, ForceLog};
    ///
    /// let mut text = "time_s,fx_n,fy_n,fz_n\n".to_owned();
    /// for row in 0..500 {
    ///     let fx = if row == 200 { 900 } else { 10 };
    ///     text += &format!("{row},{fx},0,0\n");
    /// }
    /// let done = Conditioning::new(0.0).apply(&ForceLog::read("slot.csv", &text)?)?;
    /// let worst = done.report.worst().unwrap();
    /// assert_eq!(worst, "fx_n = 900 N on line 202, at 200 s, among 10 N");
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    #[must_use]
    pub fn worst(&self) -> Option<String> {
        Some(self.of_outlier(self.worst_outlier.as_ref()?))
    }
}

/// Four significant digits.
fn significant(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
