//! What is in force at a statement: place, base, tool, speed, rounding. Each may be that of where the routine was called.

use std::collections::BTreeMap;
use std::fmt::Debug;

use crate::calls::Holds;
use crate::krl::assigned_frames::Given;
use crate::krl::values::PointData;
use crate::model::frame::FrameUse;
use crate::model::motion::Speed;
use crate::model::outside_call::OutsideCall;

/// One thing in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slot {
    /// As where the routine was called.
    Entry,
    /// A motion, or an entry of a list of [`Settings`].
    Is(usize),
    /// Not the same on every way, or not known from the text.
    Unknown,
}

/// Which thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(usize)]
pub(crate) enum Thing {
    /// The motion at whose end the tool is.
    Place,
    Base,
    Tool,
    Speed,
    /// $APO.CDIS, $APO.CPTP and $APO.CVEL.
    Distance,
    Percent,
    VelocityPercent,
    /// FDAT_ACT, LDAT_ACT, PDAT_ACT.
    PointData,
    LinearData,
    JointData,
    /// $ORI_TYPE.
    Orientation,
}

/// How many there are.
const COUNT: usize = 11;

/// All of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct State([Slot; COUNT]);

/// A set of things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Things(u16);

impl Things {
    pub(crate) const ALL: Self = Self((1 << COUNT) - 1);

    pub(crate) fn of(things: &[Thing]) -> Self {
        Self(
            things
                .iter()
                .fold(0, |set, thing| set | 1 << (*thing as usize)),
        )
    }

    pub(crate) fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub(crate) fn has(self, thing: Thing) -> bool {
        self.0 & 1 << (thing as usize) != 0
    }
}

impl State {
    pub(crate) const ENTRY: Self = Self([Slot::Entry; COUNT]);

    pub(crate) fn get(&self, thing: Thing) -> Slot {
        self.0[thing as usize]
    }

    pub(crate) fn set(&mut self, thing: Thing, slot: Slot) {
        self.0[thing as usize] = slot;
    }

    /// All that may change is not known.
    pub(crate) fn without(self, things: Things) -> Self {
        let kept = |index: usize| match things.0 & 1 << index == 0 {
            true => self.0[index],
            false => Slot::Unknown,
        };
        Self(std::array::from_fn(kept))
    }
}

impl Holds for State {
    const UNKNOWN: Self = Self([Slot::Unknown; COUNT]);

    fn merged(self, other: Self) -> Self {
        let same = |index: usize| match (self.0[index], other.0[index]) {
            (one, other) if one == other => one,
            _ => Slot::Unknown,
        };
        Self(std::array::from_fn(same))
    }

    fn in_call(self, at: Self) -> Self {
        let resolved = |index: usize| match self.0[index] {
            Slot::Entry => at.0[index],
            slot => slot,
        };
        Self(std::array::from_fn(resolved))
    }
}

/// A list without doubles.
#[derive(Debug)]
pub(crate) struct Pool<T> {
    values: Vec<T>,
    known: BTreeMap<String, usize>,
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            known: BTreeMap::new(),
        }
    }
}

impl<T: Debug> Pool<T> {
    /// Where a value is in the list.
    pub(crate) fn slot(&mut self, value: T) -> Slot {
        let key = format!("{value:?}");
        self.slot_of(key, value)
    }

    /// Where the value of a key is in the list: that of the first of equal keys stays.
    pub(crate) fn slot_of(&mut self, key: String, value: T) -> Slot {
        let next = self.values.len();
        let index = *self.known.entry(key).or_insert(next);
        if index == next {
            self.values.push(value);
        }
        Slot::Is(index)
    }

    /// The value of a slot.
    pub(crate) fn get(&self, slot: Slot) -> Option<&T> {
        match slot {
            Slot::Is(index) => self.values.get(index),
            Slot::Entry | Slot::Unknown => None,
        }
    }
}

/// What slots stand for.
#[derive(Debug, Default)]
pub(crate) struct Settings {
    pub frames: Pool<FrameUse>,
    pub speeds: Pool<Speed>,
    pub numbers: Pool<f64>,
    pub points: Pool<PointData>,
    /// Calls of what is in none of the files.
    pub calls: Vec<OutsideCall>,
    /// Tools and bases to which the program gave values up to here.
    pub given: Given,
    /// A statement lets the tool keep its orientation (`$ORI_TYPE=#CONSTANT`): where another does not is in [`Thing::Orientation`].
    pub may_keep_orientation: bool,
}

impl Settings {
    /// Whether the tool keeps its orientation, or may do so, as the slot of [`Thing::Orientation`] says.
    pub(crate) fn keeps_orientation(&self, slot: Slot) -> bool {
        let stated = match slot {
            Slot::Is(index) => Slot::Is(index),
            Slot::Entry => return false,
            Slot::Unknown => return self.may_keep_orientation,
        };
        self.numbers.get(stated).is_none_or(|kept| *kept != 0.0)
    }
}
