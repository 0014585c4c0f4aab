//! What calls of routines in none of the files may have changed for the motions behind them: such a routine may set $BASE, $TOOL and $VEL.
//!
//! A program whose places are all behind such calls has one base, whichever it is. One with places before them, too, has perhaps two, and
//! how they stand to each other only the routine says: that is refused where the call stands, once for each call.

use std::collections::BTreeMap;

use crate::calls::Holds;
use crate::error::ProgramError;
use crate::krl::motion::Followed;
use crate::krl::state::{Settings, Slot, State, Thing, Things};
use crate::krl::values::Values;
use crate::model::motion::MotionKind;
use crate::model::target::Target;

/// What is looked at, with the name by which a program states it again.
const OPEN: [(Thing, &str); 3] = [
    (Thing::Base, "$BASE"),
    (Thing::Tool, "$TOOL"),
    (Thing::Speed, "$VEL"),
];

/// What a call may have changed, and for which motion first.
struct Changed {
    things: Things,
    /// File and line.
    first: (usize, usize),
}

/// What calls may have changed for motions to places.
pub(crate) struct Unsettled {
    calls: BTreeMap<usize, Changed>,
    /// By [`OPEN`]: places with it and without it stand in one program.
    is_mixed: [bool; OPEN.len()],
}

impl Unsettled {
    /// Of motions with what is in force where their routines begin; speeds that are lost are noted of their calls.
    pub(crate) fn of(
        motions: &[Followed],
        entry: &[State],
        (values, settings): (&Values<'_>, &mut Settings),
    ) -> Self {
        let mut found = Self {
            calls: BTreeMap::new(),
            is_mixed: [false; OPEN.len()],
        };
        let mut seen = [[false; 2]; OPEN.len()];
        for followed in motions {
            let is_place = matches!(followed.motion.target, Target::Pose(_));
            let at = followed.state.in_call(entry[followed.routine]);
            for (index, (thing, name)) in OPEN.into_iter().enumerate() {
                let is_of_path = followed.motion.kind != MotionKind::Joint;
                if !is_place
                    || values.stated(name).is_some()
                    || (thing == Thing::Speed && !is_of_path)
                {
                    continue;
                }
                let lost = at.get(thing);
                seen[index][usize::from(matches!(lost, Slot::Lost { .. }))] |=
                    lost != Slot::Unknown;
                found.note(lost, thing, followed, settings);
                if let Slot::Lost { before: None, .. } = followed.state.get(thing) {
                    found.note(
                        entry[followed.routine].get(thing),
                        thing,
                        followed,
                        settings,
                    );
                }
                if let (Slot::Lost { call, .. }, Thing::Speed) = (lost, thing)
                    && let Some(call) = settings.calls.get_mut(call)
                    && call.file == followed.motion.file
                {
                    call.speeds_behind.push(followed.motion.line);
                }
            }
        }
        found.is_mixed = seen.map(|[kept, lost]| kept && lost);
        found
    }

    /// Notes the call by which something is lost, and those before it that had lost it.
    fn note(&mut self, mut lost: Slot, thing: Thing, followed: &Followed, settings: &Settings) {
        while let Slot::Lost { call, .. } = lost {
            let first = (followed.motion.file, followed.motion.line);
            let changed = self.calls.entry(call).or_insert(Changed {
                things: Things::default(),
                first,
            });
            if changed.things.has(thing) {
                return;
            }
            changed.things = changed.things.with(Things::of(&[thing]));
            changed.first = changed.first.min(first);
            let before = settings.before_calls.get(call);
            lost = before.map_or(Slot::Unknown, |before| before.get(thing));
        }
    }

    /// Whether base or tool of the program are not one behind its calls.
    pub(crate) fn is_refused(&self) -> bool {
        let [base, tool, _] = self.is_mixed;
        base || tool
    }

    /// The calls that are refused, each once.
    pub(crate) fn faults(&self, values: &Values<'_>, settings: &Settings) -> Vec<ProgramError> {
        if !self.is_refused() {
            return Vec::new();
        }
        let refused = self.calls.iter().filter_map(|(call, changed)| {
            let call = settings.calls.get(*call)?;
            let names = OPEN
                .into_iter()
                .filter(|(thing, _)| changed.things.has(*thing));
            let names: Vec<&str> = names.map(|(_, name)| name).collect();
            let source = values.files[call.file].source;
            let home = match changed.first.0 == call.file {
                true => String::new(),
                false => format!(" of {}", values.files[changed.first.0].source.name()),
            };
            let reason = format!(
                "`{}` is in none of these files, and may set {}, which line {}{home} needs",
                call.name.as_deref().unwrap_or_default(),
                names.join(", "),
                changed.first.1
            );
            let span = source.range_of(call.line);
            let remedy = "give its file as well, or state them again behind the call";
            Some(ProgramError::at(source, span, reason, remedy))
        });
        refused.collect()
    }
}
