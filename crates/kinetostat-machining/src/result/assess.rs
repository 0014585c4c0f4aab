//! Assessment of a run from its figures.

use crate::number::{against, counted, largest_length, length_setting};
use crate::result::assessment::{Assessment, Assumption, AssumptionKind, Level};
use crate::result::run_result::RunResult;

impl RunResult {
    /// Adds an assumption that the run itself does not know of, in its rank; one of the same kind is replaced.
    pub fn assume(&mut self, assumption: Assumption) {
        let all = &mut self.assessment.assumptions;
        all.retain(|other| other.kind != assumption.kind);
        all.push(assumption);
        self.assess();
    }

    /// Assesses the run anew from its figures; assumptions that were added stay.
    pub fn assess(&mut self) {
        let own = self.own_assumptions();
        let mut all = std::mem::take(&mut self.assessment.assumptions);
        all.retain(|added| !OWN.contains(&added.kind));
        all.extend(own);
        all.sort_by(|a, b| b.rank().total_cmp(&a.rank()));
        let error_mm = match self.run_inputs.compensated {
            true => self.summary.max_position_error_after_mm,
            false => self.summary.max_position_error_before_mm,
        };
        let is_critical = all.iter().any(|a| a.is_critical);
        let costs = all.iter().filter_map(|a| a.up_to_um);
        let max_error_um = costs.fold(1e3 * error_mm, kinetostat::number::larger);
        self.assessment = Assessment {
            level: Level::Analysis,
            max_error_um: (!is_critical && max_error_um.is_finite()).then_some(max_error_um),
            assumptions: all,
        };
        self.assessment.level = self.level();
    }

    /// Sentence for a tolerance that is kept only if an assumption is true; `None` if it is missed anyway, or kept in
    /// any case.
    #[must_use]
    pub fn at_worst_text(&self) -> Option<String> {
        if !self.is_doubtful() {
            return None;
        }
        let allowed = length_setting(self.allowed_mm());
        Some(match self.assessment.max_error_um {
            Some(um) => {
                let (worst, allowed) = against(1e-3 * um, self.allowed_mm());
                format!(
                    "The tolerance is kept only if the assumptions below hold: otherwise the tool is up to {worst} off with the \
                     written program, more than the {allowed} that are allowed."
                )
            }
            None => format!(
                "The tolerance of {allowed} is kept only if the assumptions below hold, and without the first of them nothing bounds the error."
            ),
        })
    }

    /// True if the written program keeps its tolerance as computed, and may miss it where an assumption fails.
    #[must_use]
    pub fn is_doubtful(&self) -> bool {
        let kept = self.holds_tolerance() == Some(true);
        let at_worst = self.assessment.max_error_um;
        // A NaN keeps nothing.
        kept && !at_worst.is_some_and(|um| um <= 1e3 * self.allowed_mm())
    }

    fn level(&self) -> Level {
        let s = &self.summary;
        if s.points == 0 && self.points.is_empty() {
            return Level::Attention;
        }
        if !s.stable || !s.converged || !s.max_position_error_before_mm.is_finite() {
            return Level::Stop;
        }
        let is_critical = self.assessment.assumptions.iter().any(|a| a.is_critical);
        if !self.run_inputs.compensated {
            return match is_critical {
                true => Level::Attention,
                false => Level::Analysis,
            };
        }
        if !s.max_position_error_after_mm.is_finite() {
            return Level::Stop;
        }
        let missed = self.features.iter().any(|f| f.held == Some(false));
        if missed || self.holds_tolerance() != Some(true) || self.is_doubtful() {
            return Level::Attention;
        }
        match self.unchanged_text() {
            Some(_) => Level::Unchanged,
            None => Level::Good,
        }
    }

    /// Assumptions that follow from the figures of the run.
    fn own_assumptions(&self) -> Vec<Assumption> {
        let s = &self.summary;
        let mut all = Vec::new();
        let mut add = |kind, cost: Option<f64>, is_critical: bool, text: Option<String>| {
            all.extend(text.map(|text| Assumption {
                is_critical,
                ..Assumption::new(kind, cost.filter(|mm| mm.is_finite()), text)
            }));
        };
        if let Some(band) = &self.force_band {
            let cost = band.max_error_mm();
            let text = self.force_band_text();
            add(AssumptionKind::ForceSpread, cost, cost.is_none(), text);
        }
        if let Some(band) = &self.uncertainty {
            let shown = band.after.as_ref().unwrap_or(&band.before);
            let text = self.uncertainty_text();
            add(
                AssumptionKind::UncertainNumbers,
                Some(shown.high_mm),
                band.unstable > 0,
                text,
            );
        }
        let readings = [
            s.max_corner_error_if_load_turns_mm,
            s.max_corner_error_if_load_follows_feed_mm,
        ];
        let cost = readings
            .into_iter()
            .flatten()
            .reduce(kinetostat::number::larger);
        let has_none = readings.contains(&None);
        let is_stated = self.run_inputs.corners_stated;
        let text = self.corners_text().filter(|_| !is_stated);
        add(AssumptionKind::Corners, cost, has_none, text);
        let backward = Some(s.largest_backward_step_mm);
        let text = self.backward_text();
        add(AssumptionKind::BackwardSteps, backward, false, text);
        add(AssumptionKind::LoadRamp, None, false, self.ramp_text());
        let text = self.own_weight_text();
        add(AssumptionKind::OwnWeight, None, false, text);
        if let Some(chatter) = &self.chatter {
            let chatters = !chatter.stretches.is_empty();
            let mut text = chatter.verdict_text();
            for more in [chatter.nearest_text(), chatter.vibration_text()] {
                text.extend(more.map(|more| format!(" {more}")));
            }
            let wall_um = chatter.worst_wall.and_then(|place| place.wall_um);
            let wall_mm = wall_um.map(|um| 1e-3 * um.abs());
            add(AssumptionKind::Chatter, wall_mm, chatters, Some(text));
        }
        all
    }

    /// Steps of the written program against the direction of motion; `None` if none is longer than what is warned of.
    #[must_use]
    pub fn backward_text(&self) -> Option<String> {
        let s = &self.summary;
        (s.backward_steps > 0).then(|| {
            format!(
                "Against the direction of motion the program has {} longer than {}, up to {}: {} nothing only if the machine yields as \
                 computed.",
                counted(s.backward_steps, "step"),
                length_setting(s.backward_step_limit_mm),
                largest_length(s.largest_backward_step_mm),
                match s.backward_steps {
                    1 => "it cuts",
                    _ => "they cut",
                }
            )
        })
    }
}

/// Kinds that follow from the figures of a run.
const OWN: [AssumptionKind; 7] = [
    AssumptionKind::ForceSpread,
    AssumptionKind::UncertainNumbers,
    AssumptionKind::Corners,
    AssumptionKind::BackwardSteps,
    AssumptionKind::LoadRamp,
    AssumptionKind::OwnWeight,
    AssumptionKind::Chatter,
];
