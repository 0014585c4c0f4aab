//! A milling cut: what is asked.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engagement::Engagement;
use crate::law::ForceLaw;
use crate::milling::chip::Chips;
use crate::milling::feed::Feed;
use crate::tool::Tool;

/// Sense of rotation of the spindle, seen from it down to the tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Rotation {
    /// M3.
    #[default]
    Clockwise,
    /// M4.
    CounterClockwise,
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

    /// Sets the sense of rotation: counter-clockwise is the mirror image of clockwise.
    #[must_use]
    pub fn turning(mut self, rotation: Rotation) -> Self {
        if rotation != self.rotation {
            self.engagement = Cow::Owned(self.engagement.mirrored());
            self.rotation = rotation;
        }
        self
    }

    /// Converts a result for a clockwise spindle to the actual sense of rotation.
    pub(crate) fn as_it_turns<T>(&self, of: T, mirrored: impl FnOnce(&T) -> T) -> T {
        match self.rotation {
            Rotation::Clockwise => of,
            Rotation::CounterClockwise => mirrored(&of),
        }
    }
}
