//! Resolution of the chatter analysis along a program: `[chatter]` of a job, options of `chatter`.

use kinetostat_chatter::Swinging;
use kinetostat_dynamics::Damping;

use crate::job::job_file::JobFile;
use crate::job::values::{NotAllowed, above_zero, chosen};
use crate::ui::failure::Answer;

/// Modes up to this frequency vibrate whether they count or not, Hz.
const AT_LEAST_HZ: f64 = 300.0;

/// Resolution of the chatter analysis.
#[derive(Clone, Debug)]
pub(crate) struct ChatterSetting {
    /// Damping of the job; without it that of the model.
    pub(crate) damping: Option<Damping>,
    /// Modes that are kept dynamic; the others enter as residual flexibility.
    pub(crate) swinging: Swinging,
    /// Places farther apart are judged by themselves, mm.
    pub(crate) every_mm: f64,
    /// Upper limit of the places that are judged.
    pub(crate) most_places: usize,
}

/// Settings as options, with priority over the job.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ChatterFlags {
    pub(crate) modes_up_to_hz: Option<f64>,
    pub(crate) every_mm: Option<f64>,
    pub(crate) most_places: Option<usize>,
}

impl ChatterSetting {
    /// Settings of a job that requests the chatter analysis.
    pub(crate) fn of_job(job: Option<&JobFile>) -> Answer<Option<Self>> {
        let asks = job.is_some_and(|j| j.job.chatter.is_some());
        asks.then(|| Self::of(job, ChatterFlags::default()))
            .transpose()
    }

    /// Settings of a job and options.
    pub(crate) fn of(job: Option<&JobFile>, flags: ChatterFlags) -> Answer<Self> {
        let table = job.and_then(|j| Some(j.job.chatter.as_ref()?.get_ref()));
        let ratio = chosen(
            job,
            "damping_ratio",
            None,
            table.and_then(|t| t.damping_ratio.as_ref()),
            |ratio| match ratio > 0.0 && ratio < 1.0 {
                true => Ok(ratio),
                false => Err(NotAllowed(
                    "a ratio to critical damping above 0 and below 1 is needed: 0.03 is 3 %",
                )),
            },
        )?;
        let modes_up_to_hz = chosen(
            job,
            "--modes-up-to-hz",
            flags.modes_up_to_hz,
            table.and_then(|t| t.modes_up_to_hz.as_ref()),
            above_zero,
        )?;
        let every_mm = chosen(
            job,
            "--every-mm",
            flags.every_mm,
            table.and_then(|t| t.every_mm.as_ref()),
            above_zero,
        )?;
        let most_places = chosen(
            job,
            "--most-places",
            flags.most_places,
            table.and_then(|t| t.most_places.as_ref()),
            |count| match (1..=1_000_000).contains(&count) {
                true => Ok(count),
                false => Err(NotAllowed("a number from 1 to 1000000 is needed")),
            },
        )?;
        Ok(Self {
            damping: ratio.map(Damping::Ratio),
            swinging: modes_up_to_hz.map_or(Swinging::AtLeastTo(AT_LEAST_HZ), Swinging::UpTo),
            every_mm: every_mm.unwrap_or(25.0),
            most_places: most_places.unwrap_or(2000),
        })
    }
}
