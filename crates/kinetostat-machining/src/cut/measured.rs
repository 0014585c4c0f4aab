//! Measured forces along a program.

use kinetostat::number::larger;
use kinetostat_cutting::{
    Activity, Conditioning, CutError, CutErrorKind, DriftModel, ForceLog, LoggedBy,
    OutlierTreatment, ShiftMatch, match_shift,
};
use kinetostat_program::{Move, MoveKind, Path};

use crate::cut::clock::{Clock, DwellUnit, Timing, cuts, longest_revolution};
use crate::cut::finding::{CutFailure, CutFinding, CutFindingKind, Findings};
use crate::cut::measured_stations::{ActsOn, Laid, MeasuredAxes, MeasuredReport, step};
use crate::cut::profile::ForceAlongPath;
use crate::watch::Watch;

/// Moves between two looks at whether to stop.
const MOVES_PER_LOOK: usize = 2000;

/// A log of forces and what is known of it.
///
/// ```
/// use kinetostat_cutting::{ForceLog, LoggedBy};
/// use kinetostat_machining::{ActsOn, ForceOrigin, MeasuredAxes, MeasuredForces, Unwatched};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// // Two cuts of 4 and 2 s with a rapid of 1 s between them; a log that begins 1.5 s before the first.
/// let text = "G21 G90\nS6000 M3\nG0 X0 Y0 Z0\nG1 X40 F600\nG0 Y10\nG1 X20\n";
/// let path = interpret(&Program::read(text)?, &ReadOptions::default())?;
/// let cut = |t: f64| (1.5..5.5).contains(&t) || (6.5..8.5).contains(&t);
/// let at: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
/// let fy = at.iter().map(|t| if cut(*t) { -30.0 } else { 0.0 }).collect();
/// let log = ForceLog::new(LoggedBy::Time, at, [vec![0.0; 1000], fy, vec![0.0; 1000]], None)?;
///
/// let mut measured = MeasuredForces::new(log, ActsOn::Part);
/// measured.axes = MeasuredAxes::Part;
/// measured.rapid_mm_per_minute = Some(600.0);
/// let forces = measured.along(&path, &Unwatched)?;
/// let report = forces.measured.as_ref().unwrap();
/// assert!((report.shift_s.unwrap() - 1.5).abs() < 0.01);
/// assert_eq!(forces.origin(), ForceOrigin::Measured);
/// assert!(report.gap().is_none() && report.sentences()[0].starts_with("measured: 1000 rows"));
/// // On the tool it acts along +y of the part: to the left of the feed on the way out, to the right on the way back.
/// assert!((forces.wrench(1, 0.5).force().y - 30.0).abs() < 1e-9);
/// assert!((forces.wrench(3, 0.5).force().y + 30.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MeasuredForces {
    /// Forces over time or along the path, N; moments about the tool's tip, N m.
    pub log: ForceLog,
    /// Axes of the log. Default: those of the program.
    pub axes: MeasuredAxes,
    /// Body on which the logged force acts.
    pub acts_on: ActsOn,
    /// Time of the log at which the first cut of the program begins, s; `None`: by correlation.
    pub shift_s: Option<f64>,
    /// Window of the moving mean, s or mm; `None`: the longest revolution of the spindle in a cut.
    pub smooth: Option<f64>,
    /// Stretches of the log in which the tool is in air, s or mm.
    pub air: Vec<[f64; 2]>,
    /// Interpolation of the drift between them.
    pub drift: DriftModel,
    /// Treatment of outliers.
    pub outliers: OutlierTreatment,
    /// Speed of rapids, mm/min; needed where there are rapids between cuts.
    pub rapid_mm_per_minute: Option<f64>,
    /// Unit of the P of dwells; needed if there are dwells between cuts.
    pub dwell_unit: Option<DwellUnit>,
    /// Speed of the spindle instead of the program's, rpm.
    pub rpm: Option<f64>,
}

impl MeasuredForces {
    /// A log of which nothing else is known.
    #[must_use]
    pub fn new(log: ForceLog, acts_on: ActsOn) -> Self {
        Self {
            log,
            acts_on,
            axes: MeasuredAxes::default(),
            shift_s: None,
            smooth: None,
            air: Vec::new(),
            drift: DriftModel::default(),
            outliers: OutlierTreatment::default(),
            rapid_mm_per_minute: None,
            dwell_unit: None,
            rpm: None,
        }
    }

    /// The forces along a path: conditioned ([`Conditioning`]), shifted so that log and program agree, and laid along the cuts
    /// by the time that each move takes at its feed, or by the length along them. Torque, depth and arc of the stations are 0:
    /// a log does not say them. Moves that the log does not cover have no force, and a finding.
    ///
    /// # Errors
    /// A time of a move, or the speed of the spindle, that is stated nowhere, with its line; a log that cannot be conditioned or
    /// whose shift is not distinct ([`match_shift`]); a shift for a log along the path; one that leaves no cut in the log.
    pub fn along(&self, path: &Path, watch: &dyn Watch) -> Result<ForceAlongPath, CutFailure> {
        let of_log = |error| CutFailure::Log {
            error: Box::new(error),
        };
        watch.stage("measured forces", path.moves.len());
        let clock = match self.log.by() {
            LoggedBy::Time => Clock::by_time(path, &self.timing())?,
            LoggedBy::AlongPath => Clock::by_length(path),
        };
        let window = self.window(path)?;
        let conditioning = Conditioning::new(window)
            .with_air(self.air.clone())
            .with_drift(self.drift)
            .with_outliers(self.outliers);
        let done = conditioning.apply(&self.log).map_err(of_log)?;
        let (shift, matched) = self.shift(&done.log, path, &clock).map_err(of_log)?;
        let laid = Laid {
            log: &done.log,
            clock: &clock,
            shift,
            axes: self.axes,
            acts_on: self.acts_on,
            step: step(window, &clock),
        };
        let mut moves = Vec::with_capacity(path.moves.len());
        let mut in_part = Vec::new();
        for i in 0..path.moves.len() {
            if i % MOVES_PER_LOOK == 0 {
                watch.advance(i);
                if watch.cancelled() {
                    return Err(CutFailure::Cancelled);
                }
            }
            let [feed, part] = laid.stations(path, i);
            moves.push(feed);
            if self.axes == MeasuredAxes::Part {
                in_part.push(part);
            }
        }
        self.some_cut_is_covered(&laid, path).map_err(of_log)?;
        let report = MeasuredReport {
            conditioning: done.report,
            shift_s: (self.log.by() == LoggedBy::Time).then_some(shift),
            matched,
            rapid_mm_per_minute: self.rapid_mm_per_minute,
            axes: self.axes,
            acts_on: self.acts_on,
        };
        let in_part = (self.axes == MeasuredAxes::Part).then_some(in_part.as_slice());
        let mut forces = ForceAlongPath::of_measured(moves, in_part, Vec::new(), report);
        let margin = 0.5 * window + matched.map_or(0.0, |matched| matched.within_s);
        let largest = forces.largest().force().norm();
        forces.findings = findings(&laid, path, largest, margin, &self.air);
        Ok(forces)
    }

    fn timing(&self) -> Timing {
        Timing {
            rapid_mm_per_minute: self.rapid_mm_per_minute,
            rpm: self.rpm,
            dwell_unit: self.dwell_unit,
        }
    }

    /// The window of the moving mean, s or mm.
    fn window(&self, path: &Path) -> Result<f64, CutFailure> {
        let found = match (self.smooth, self.log.by()) {
            (Some(stated), _) => Some(stated),
            (None, LoggedBy::Time) => longest_revolution(path, self.rpm, |_, rpm| Some(60.0 / rpm)),
            (None, LoggedBy::AlongPath) => {
                longest_revolution(path, self.rpm, |m, rpm| m.feed_mm_per_revolution(rpm))
            }
        };
        let first = path.moves.iter().find(|m| m.kind == MoveKind::Feed);
        found.ok_or(CutFailure::Missing {
            line: first.map_or(1, |m| m.line),
            what: "a revolution to smooth over is not known (S with G97, M3 or M4)",
            help: "add the words to the program, or state over what to smooth (smooth_s or smooth_mm)",
        })
    }

    /// Time or length of the log less that of the program, and how it was found.
    fn shift(
        &self,
        log: &ForceLog,
        path: &Path,
        clock: &Clock,
    ) -> kinetostat_cutting::Result<(f64, Option<ShiftMatch>)> {
        match (self.shift_s, log.by()) {
            (Some(shift), LoggedBy::Time) => Ok((shift, None)),
            (Some(shift), LoggedBy::AlongPath) => Err(CutError::new(
                CutErrorKind::Measurement,
                "shift",
                format!("{shift} s for a log along the path"),
                "none: its places are those of the program",
            )),
            (None, LoggedBy::AlongPath) => Ok((0.0, None)),
            (None, LoggedBy::Time) => {
                // Force in feed moves, none in rapids.
                let found = match_shift(log, &Activity::new(clock.activity(path))?)?;
                Ok((found.shift_s, Some(found)))
            }
        }
    }

    fn some_cut_is_covered(&self, laid: &Laid<'_>, path: &Path) -> kinetostat_cutting::Result<()> {
        let mut cuts = (0..path.moves.len()).filter(|i| crate::cut::clock::cuts(&path.moves[*i]));
        if cuts.any(|i| laid.covered(i).is_some()) {
            return Ok(());
        }
        let unit = self.log.by().unit();
        let [first, last] = self.log.range();
        Err(CutError::new(
            CutErrorKind::Measurement,
            "log",
            format!("{first} to {last} {unit}, in which no cut of the program lies"),
            "a log of this program, and its shift",
        ))
    }
}

/// Share of the largest force that is no force yet.
const NOISE: f64 = 0.05;

/// Share of a move that need not be covered: that of a rounded number.
const ROUNDED: f64 = 1e-6;

/// Warnings about measured forces. `largest_n` is the largest force of a cut, N; `margin` is the uncertainty, s, of the place of
/// a rapid together with the window of the mean; `air` are stretches in air, s of the log.
fn findings(
    laid: &Laid<'_>,
    path: &Path,
    largest_n: f64,
    margin: f64,
    air: &[[f64; 2]],
) -> Vec<CutFinding> {
    let mut findings = Findings::default();
    for i in &laid.clock.unknown {
        let line = path.moves[*i].line;
        findings.add(CutFindingKind::TimeUnknown, line, 0.0, || {
            "where this move begins is not known, and so not how long it takes: it is taken to take no time"
                .to_owned()
        });
    }
    for (line, kind) in &laid.clock.pauses {
        findings.add(CutFindingKind::TimeUnknown, *line, 1.0, || {
            format!(
                "how long {} takes is stated nowhere: it is taken to take no time, and what the log has behind it would be too early; cut program and log in two there",
                kind.description()
            )
        });
    }
    let in_air = air.iter().map(|stretch| largest_in(laid, *stretch));
    let noise = 1.5 * in_air.fold(0.0, larger);
    let least = larger(NOISE * largest_n, noise);
    for (i, motion) in path.moves.iter().enumerate() {
        if cuts(motion) {
            not_measured(laid, motion, i, &mut findings);
        }
        let Some([from, to]) = laid.covered(i) else {
            continue;
        };
        if motion.kind == MoveKind::Rapid && to - from > 2.0 * margin {
            let size = largest_in(laid, [from + margin, to - margin]);
            if size > least {
                findings.add(CutFindingKind::ForceInRapid, motion.line, size, || {
                    format!(
                        "{size:.1} N were measured in a rapid, {:.0} % of the largest force: the log or its shift is not that of this program, the drift is not removed, or the tool touches the part",
                        100.0 * size / largest_n
                    )
                });
            }
        }
    }
    findings.list()
}

fn not_measured(laid: &Laid<'_>, motion: &Move, i: usize, findings: &mut Findings) {
    let [from, to] = laid.span(i);
    let covered = laid.covered(i).map_or(0.0, |[from, to]| to - from);
    let missing = 1.0 - covered / (to - from);
    if missing > ROUNDED {
        let length = motion.length_mm();
        findings.add(
            CutFindingKind::NotMeasured,
            motion.line,
            missing * length,
            || {
                format!(
                    "the log covers {:.2} mm of {length:.2} mm of this move: no force acts on the rest",
                    (1.0 - missing) * length
                )
            },
        );
    }
}

/// The largest force between two places of the log, N.
fn largest_in(laid: &Laid<'_>, [from, to]: [f64; 2]) -> f64 {
    let rows = laid.log.rows_between(from, to).iter().copied();
    let places = rows.chain([from, to]);
    places.map(|at| laid.size(at)).fold(0.0, larger)
}
