//! Places along the path at which deviations and corrections are kept.

use kinetostat_program::NominalPath;

/// Stations in a smoothing length: on cubic curves between them nothing is lost of what the kernel lets through.
const IN_SMOOTHING_LENGTH: f64 = 4.0;

/// Places along each pass, evenly from its beginning to its end.
///
/// ```
/// use kinetostat_mirror::{NominalPath, Stations};
/// use kinetostat_program::{Program, ReadOptions, interpret};
///
/// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// let stations = Stations::of(&NominalPath::new(&path)?, 10.0);
/// assert_eq!(stations.along_mm(), [0.0, 2.5, 5.0, 7.5, 10.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stations {
    along_mm: Vec<f64>,
    /// Of each pass, where in the list.
    passes: Vec<std::ops::Range<usize>>,
}

impl Stations {
    /// Four stations on a smoothing length, two at least on each pass.
    #[must_use]
    pub fn of(nominal: &NominalPath<'_>, smoothing_mm: f64) -> Self {
        let mut along_mm = Vec::new();
        let mut passes = Vec::new();
        for pass in nominal.passes() {
            let [from, to] = pass.along_mm;
            let parts = ((to - from) * IN_SMOOTHING_LENGTH / smoothing_mm).ceil();
            let parts = parts.max(1.0) as usize;
            let first = along_mm.len();
            along_mm.extend((0..=parts).map(|k| from + (to - from) * (k as f64 / parts as f64)));
            passes.push(first..along_mm.len());
        }
        Self { along_mm, passes }
    }

    /// Their lengths along the path, mm; the end of a pass and the beginning of the next have the same.
    #[must_use]
    pub fn along_mm(&self) -> &[f64] {
        &self.along_mm
    }

    /// Of each pass, which stations are on it.
    #[must_use]
    pub fn passes(&self) -> &[std::ops::Range<usize>] {
        &self.passes
    }

    /// The length of path that each of them stands for, mm.
    pub(crate) fn lengths_mm(&self) -> Vec<f64> {
        let mut lengths = vec![0.0; self.along_mm.len()];
        for pass in &self.passes {
            for k in pass.start..pass.end - 1 {
                let half = 0.5 * (self.along_mm[k + 1] - self.along_mm[k]);
                lengths[k] += half;
                lengths[k + 1] += half;
            }
        }
        lengths
    }
}
