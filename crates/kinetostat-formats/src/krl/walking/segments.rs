//! Motions, and the spline blocks in which they may stand.

use std::ops::Range;

use crate::krl::motion::{Statement as MotionStatement, follow};
use crate::krl::state::{Slot, State, Thing};
use crate::krl::table::{Ends, MotionRow};
use crate::krl::usage::ends_of;
use crate::krl::walking::walker::Walker;
use crate::krl::with_list::with;
use crate::model::motion::Zone;
use crate::text::finding::Finding;
use crate::text::name::Name;

impl Walker<'_, '_> {
    /// `SPLINE WITH $VEL.CP=0.2` and `ENDSPLINE C_SPL`: what the first puts in force, the second takes back.
    pub(super) fn spline_word(&mut self, tokens: &Range<usize>, mut state: State) -> State {
        let file = self.file();
        let begins = file
            .name(tokens.start)
            .is_some_and(|name| name.is("SPLINE"));
        match (begins, self.now.spline.take()) {
            (true, None) => {
                self.now.spline = Some(state);
                let is_with = file
                    .name(tokens.start + 1)
                    .is_some_and(|name| name.is("WITH"));
                if is_with && tokens.len() > 1 {
                    let routine = self.now.routine;
                    let to = (self.values, &mut self.settings, routine);
                    if let Err(reason) = with(to, &(tokens.start + 2..tokens.end), &mut state) {
                        self.refuse(tokens, reason);
                    }
                }
                state
            }
            (false, Some(mut before)) => {
                before.set(Thing::Place, state.get(Thing::Place));
                before
            }
            (_, open) => {
                self.now.spline = open;
                let reason = "a spline block begins in another one, or ends without a beginning";
                self.refuse(
                    tokens,
                    (
                        reason.to_owned(),
                        "write SPLINE, its segments, and ENDSPLINE",
                    ),
                );
                state
            }
        }
    }

    /// `TRIGGER WHEN DISTANCE=1` and `WHEN PATH=-20`, and `STOP WHEN PATH`, act along the next motion or at its end: before several that
    /// take its place they would act at the end of the first.
    pub(super) fn notes_what_acts_along(&mut self, name: &Name, tokens: &Range<usize>) {
        let file = self.file();
        let word = |at: usize, word: &str| file.name(at).is_some_and(|found| found.is(word));
        let from_start = tokens.clone().any(|at| {
            let zero = word(at, "DISTANCE") && file.is(at + 1, b'=') && file.word(at + 2) == b"0";
            zero || word(at, "ONSTART")
        });
        if from_start {
            return;
        }
        if name.is("TRIGGER") {
            self.now.along_next = Some("the TRIGGER before it acts along the whole of it");
        } else if name.is("STOP") && word(tokens.start + 1, "WHEN") {
            self.now.along_next = Some("the STOP WHEN before it acts along the whole of it");
        }
    }

    /// `PTP $AXIS_ACT`, `PTP $POS_ACT`: to where the arm is. It stops there, with which the way to the first point of a program begins.
    fn goes_nowhere(&mut self, row: &MotionRow, tokens: &Range<usize>) -> bool {
        let file = self.file();
        let ends = ends_of(file, tokens, row.ends);
        let (Ends::Joint | Ends::Linear, [end]) = (row.ends, ends.as_slice()) else {
            return false;
        };
        let name = file.name(end.start).filter(|_| end.len() == 1);
        let is_actual = name.is_some_and(|name| name.is("$AXIS_ACT") || name.is("$POS_ACT"));
        if is_actual {
            let shown = file.text(end);
            self.findings.push(Finding {
                file: file.index,
                line: file.source.line_of(file.span(tokens).start),
                message: format!(
                    "`{shown}` is where the arm is: the motion stops there and goes nowhere, it is carried"
                ),
            });
        }
        is_actual
    }

    /// Notes a motion with what is in force as it runs.
    pub(super) fn moves(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
        mut state: State,
    ) -> State {
        let in_spline = self.now.spline.is_some();
        if in_spline && !matches!(row.name, "SLIN" | "SCIRC") {
            self.refuse(
                tokens,
                (
                    "it is no segment of a spline block".to_owned(),
                    "write SLIN or SCIRC, or write it behind ENDSPLINE",
                ),
            );
            state.set(Thing::Place, Slot::Unknown);
            return state;
        }
        if !in_spline && self.goes_nowhere(row, tokens) {
            return state;
        }
        let statement = MotionStatement {
            row,
            routine: self.now.routine,
            tokens,
            in_block: in_spline,
        };
        let followed = follow(
            &statement,
            self.values,
            self.targets,
            &mut self.settings,
            state,
            self.unknown,
        );
        match followed {
            Ok(mut followed) => {
                followed.motion.runs = self.now.runs;
                let site = &mut followed.motion.site;
                site.indivisible = site.indivisible.or(self.now.along_next.take());
                // Segments pass their ends.
                if in_spline && followed.motion.zone == Zone::Exact {
                    followed.motion.zone = Zone::Unstated;
                }
                self.motions.push(followed);
                state.set(Thing::Place, Slot::Is(self.motions.len() - 1));
            }
            Err(reason) => {
                self.refuse(tokens, reason);
                state.set(Thing::Place, Slot::Unknown);
            }
        }
        state
    }
}
