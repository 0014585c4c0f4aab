//! The probe at arming: tells an absolute correction object from a relative one before anything moves far.
//!
//! Whether a controller takes a correction as a total or as an increment is set in the controller and not in its
//! packets; a relative object fed with totals runs away by 165 mm in 3 s (theory note, on-line, section 3). The probe asks for 0.02 mm for ten
//! cycles and for nothing afterwards: an absolute object moves by 0.02 mm and comes back, a relative one ends at 0.2 mm at most, whatever its delay.

/// Settings of a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeSettings {
    /// Correction that is asked for, m.
    pub amplitude: f64,
    /// Number of cycles in which it is asked for.
    pub cycles: u32,
    /// Number of cycles after that in which the pose may come back: the delay of the controller.
    pub settling: u32,
    /// Direction, base axes; need not be normalised. Away from the part.
    pub direction: nalgebra::Vector3<f64>,
}

impl Default for ProbeSettings {
    fn default() -> Self {
        Self {
            amplitude: 2e-5,
            cycles: 10,
            settling: 50,
            direction: nalgebra::Vector3::z(),
        }
    }
}

/// Finding of a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Verdict {
    /// Still probing.
    Running,
    /// The pose moved by the amplitude and came back.
    Absolute,
    /// The pose moved by more than twice the amplitude, or did not come back: corrections are summed up.
    Relative,
    /// The pose moved by less than half the amplitude: corrections do not arrive.
    Silent,
}

/// One probe of a correction object, by cycles.
///
/// ```
/// use kinetostat_online::{Probe, ProbeSettings, Verdict};
///
/// let settings = ProbeSettings::default();
/// // A controller that adds up what it is sent.
/// let (mut probe, mut moved) = (Probe::new(), 0.0);
/// let verdict = loop {
///     let (request, verdict) = probe.next(&settings, moved); // m
///     if verdict != Verdict::Running {
///         break verdict;
///     }
///     moved += request;
/// };
/// assert_eq!(verdict, Verdict::Relative);
/// assert!(moved < 0.25e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probe {
    cycle: u32,
    farthest: f64,
    last: f64,
}

impl Probe {
    /// A probe that has not begun.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One cycle: takes the offset of the controller's pose from the program's along the direction (m) and returns the
    /// correction to send (m, along the direction) with the verdict. A reading that is not finite is a runaway.
    pub fn next(&mut self, settings: &ProbeSettings, observed: f64) -> (f64, Verdict) {
        let amplitude = settings.amplitude;
        let size = if observed.is_finite() {
            observed.abs()
        } else {
            f64::INFINITY
        };
        self.farthest = kinetostat::number::larger(self.farthest, size);
        self.last = size;
        if self.farthest > 2.0 * amplitude {
            return (0.0, Verdict::Relative);
        }
        let cycle = self.cycle;
        self.cycle = self.cycle.saturating_add(1);
        if cycle < settings.cycles {
            return (amplitude, Verdict::Running);
        }
        if cycle < settings.cycles.saturating_add(settings.settling) {
            return (0.0, Verdict::Running);
        }
        let verdict = if self.farthest < 0.5 * amplitude {
            Verdict::Silent
        } else if self.last > 0.25 * amplitude {
            Verdict::Relative
        } else {
            Verdict::Absolute
        };
        (0.0, verdict)
    }
}
