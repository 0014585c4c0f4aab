//! A milling cut: what is asked.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::engagement::Engagement;
use crate::error::{CutErrorKind, Result, within};
use crate::law::ForceLaw;
use crate::milling::chip::Chips;
use crate::tool::Tool;

/// Which way the spindle turns, seen from it down to the tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rotation {
    /// M3.
    #[default]
    Clockwise,
    /// M4.
    CounterClockwise,
}

/// How far the tool goes from tooth to tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed {
    /// Across the tool axis, mm per tooth.
    pub level_mm: f64,
    /// Down along the tool axis, mm per tooth; negative where the tool rises.
    pub down_mm: f64,
}

impl Feed {
    /// Across the tool axis, mm per tooth.
    ///
    /// # Errors
    /// Negative, or more than 10 mm.
    pub fn level(per_tooth_mm: f64) -> Result<Self> {
        Self::ramp(per_tooth_mm, 0.0)
    }

    /// Across the tool axis and down along it, mm per tooth.
    ///
    /// # Errors
    /// Negative across, or more than 10 mm either way.
    pub fn ramp(level_mm: f64, down_mm: f64) -> Result<Self> {
        let cut = CutErrorKind::Cut;
        within(cut, "feed per tooth", level_mm, 0.0..=10.0, "mm")?;
        within(
            cut,
            "feed per tooth down the axis",
            down_mm,
            -10.0..=10.0,
            "mm",
        )?;
        Ok(Self { level_mm, down_mm })
    }
}

/// A cut of a milling tool with a law of force.
#[derive(Clone, Debug)]
pub struct Milling<'a, L: ForceLaw + ?Sized> {
    pub(crate) tool: &'a Tool,
    pub(crate) law: &'a L,
    pub(crate) engagement: Cow<'a, Engagement>,
    pub(crate) feed: Feed,
    pub(crate) chips: Chips,
    pub(crate) rotation: Rotation,
}

impl<'a, L: ForceLaw + ?Sized> Milling<'a, L> {
    /// A cut with a spindle that turns clockwise (M3).
    #[must_use]
    pub fn new(tool: &'a Tool, law: &'a L, engagement: &'a Engagement, feed: Feed) -> Self {
        Self {
            tool,
            law,
            engagement: Cow::Borrowed(engagement),
            feed,
            chips: Chips::new(tool),
            rotation: Rotation::Clockwise,
        }
    }

    /// The same with a spindle that turns this way: counter-clockwise is the mirror image of clockwise.
    #[must_use]
    pub fn turning(mut self, rotation: Rotation) -> Self {
        if rotation != self.rotation {
            self.engagement = Cow::Owned(self.engagement.mirrored());
            self.rotation = rotation;
        }
        self
    }

    /// What the sums give for a clockwise spindle, as it is with this one.
    pub(crate) fn as_it_turns<T>(&self, of: T, mirrored: impl FnOnce(&T) -> T) -> T {
        match self.rotation {
            Rotation::Clockwise => of,
            Rotation::CounterClockwise => mirrored(&of),
        }
    }
}
