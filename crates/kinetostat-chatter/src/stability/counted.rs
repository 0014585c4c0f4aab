//! Stability at a speed with the modes that count there.

use crate::cut::{checked_depth, checked_speed};
use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::stability::eigenvalues::ROUGH;
use crate::stability::multiplier::SpeedStability;
use crate::stability::period::resolved_hz;
use crate::stability::regeneration::{Regeneration, Selected};
use crate::stability::scan::{Along, Search};
use crate::stability::swinging::Known;

/// Share of the usual points of collocation at one look, and the logarithm of a multiplier from which it is unstable for certain.
const LOOK: f64 = 0.75;
const CLEARLY: f64 = 1e-3;

impl Regeneration {
    /// Stability at a spindle speed (rpm) for all depths up to a largest one (m).
    ///
    /// ```
    /// use kinetostat_chatter::{Arc, Coefficients, MillingCut, Mode, Regeneration, ToolResponse};
    ///
    /// let mode = Mode::along([1.0, 0.0, 0.0].into(), 0.03993, 922.0, 0.011)?; // kg, Hz
    /// let cut = MillingCut::new(2, Arc::slot(), Coefficients::new(6e8, 2e8, 0.0)?)?;
    /// let slot = Regeneration::new(ToolResponse::new(vec![mode])?, cut.into())?;
    /// let stability = slot.stability_at(5000.0, 1e-3)?; // rpm, m
    /// let limit = stability.limit().expect("a limit below 1 mm");
    /// assert!((limit.depth / 0.408628e-3 - 1.0).abs() < 1e-4);
    /// # Ok::<(), kinetostat_chatter::ChatterError>(())
    /// ```
    ///
    /// # Errors
    /// A speed or a depth that is not positive, and modes too fast for the speed ([`crate::ToolResponse::with_modes_up_to`]).
    pub fn stability_at(&self, speed_rpm: f64, up_to: f64) -> Result<SpeedStability> {
        self.stability_beyond(None, speed_rpm, up_to, Search::All)
    }

    /// Continues [`Self::stability_at`] at the speed of `known`, a result for this cut up to a smaller depth: if it has
    /// no limit and the same modes are dynamic, only the depths beyond are searched.
    ///
    /// # Errors
    /// See [`Self::stability_at`].
    pub fn stability_continued(
        &self,
        known: &SpeedStability,
        up_to: f64,
    ) -> Result<SpeedStability> {
        self.stability_beyond(Some(known), known.speed_rpm, up_to, Search::All)
    }

    /// Finds the limit like [`Self::stability_at`] or, with a result for smaller depths, [`Self::stability_continued`]:
    /// depths above the limit are not searched.
    ///
    /// # Errors
    /// See [`Self::stability_at`].
    pub fn first_limit(
        &self,
        known: Option<&SpeedStability>,
        speed_rpm: f64,
        up_to: f64,
    ) -> Result<SpeedStability> {
        self.stability_beyond(known, speed_rpm, up_to, Search::First)
    }

    /// True if the cut is unstable at a spindle speed (rpm) and a depth (m), by one look at its largest multiplier. False where it
    /// is stable there, however it is at smaller depths, and where one look does not tell: near the limit, and where modes
    /// count that do not vibrate in [`Self::stability_at`] at first.
    ///
    /// # Errors
    /// As [`Self::stability_at`].
    pub fn is_unstable_at(&self, speed_rpm: f64, depth: f64) -> Result<bool> {
        checked_speed(speed_rpm)?;
        checked_depth(depth)?;
        let of = |regeneration: &Self| -> Result<bool> {
            let along = Along::new(regeneration, speed_rpm, LOOK)?;
            Ok(along.logarithm(depth, ROUGH)? > CLEARLY)
        };
        let Some(Selected { selection, usual }) = self.selected() else {
            return of(self);
        };
        let resolved_hz = resolved_hz(self.cut(), speed_rpm, depth);
        let is_known = |mode: &Known| mode.alone >= depth;
        let others = &selection.modes[selection.count..];
        match others.iter().all(is_known)
            && (!selection.automatic || selection.up_to(resolved_hz) >= selection.count)
        {
            true => of(usual),
            false => Ok(false),
        }
    }

    fn stability_beyond(
        &self,
        known: Option<&SpeedStability>,
        speed_rpm: f64,
        up_to: f64,
        search: Search,
    ) -> Result<SpeedStability> {
        checked_speed(speed_rpm)?;
        checked_depth(up_to)?;
        match self.selected() {
            Some(selected) => self.stability_of(selected, known, speed_rpm, up_to, search),
            None => self.stability_of_all(known, speed_rpm, up_to, search),
        }
    }

    /// Stability with the contributing modes; more of them are dynamic if they could chatter by themselves below the
    /// limit that is found.
    fn stability_of(
        &self,
        selected: &Selected,
        known: Option<&SpeedStability>,
        speed_rpm: f64,
        up_to: f64,
        search: Search,
    ) -> Result<SpeedStability> {
        let Selected { selection, usual } = selected;
        let resolved = match selection.automatic {
            true => selection.up_to(resolved_hz(self.cut(), speed_rpm, up_to)),
            false => selection.count,
        };
        let mut count = selection.count.min(resolved);
        loop {
            let found = match count == selection.count {
                true => usual.stability_of_all(known, speed_rpm, up_to, search)?,
                false => self
                    .lowest(count)
                    .stability_of_all(known, speed_rpm, up_to, search)?,
            };
            let reach = found.limit().map_or(up_to, |limit| limit.depth);
            let could = |mode: &Known| mode.alone < reach;
            if let Some(more) = selection.modes[count..resolved].iter().rposition(could) {
                count += more + 1;
                continue;
            }
            let unseen = selection.modes[count..].iter().find(|mode| could(mode));
            if let (true, Some(mode)) = (selection.automatic, unseen) {
                return Err(ChatterError::new(
                    ChatterErrorKind::NotConverged,
                    format!("limit at {speed_rpm} rpm up to {:.4} mm", 1e3 * up_to),
                    format!(
                        "the mode at {:.2} Hz vibrates too often while a tooth is in the cut to be followed, and could chatter by itself from {:.4} mm on",
                        mode.of.frequency_hz,
                        1e3 * mode.alone
                    ),
                    "a higher speed, a smaller depth, or modes up to a frequency of your own: faster ones are springs then",
                ));
            }
            let left = selection.modes[count..].iter();
            let left = left.filter(|mode| mode.counts() || could(mode));
            let left = left.map(|mode| mode.of);
            return Ok(SpeedStability {
                left_out: left.max_by(|a, b| a.share.total_cmp(&b.share)),
                ..found
            });
        }
    }
}
