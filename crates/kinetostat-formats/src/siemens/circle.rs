//! Arcs and circles as blocks state them.

use nalgebra::{Point3, Vector3};

use crate::model::motion::MotionKind;
use crate::model::target::Target;
use crate::siemens::arcs::{Reason, again, arc};
use crate::siemens::made_motion::Known;
use crate::siemens::state::Code;
use crate::siemens::walker::Reader;
use crate::siemens::words::Words;

impl Reader<'_> {
    /// The arc of a block from a place to another, in the frame's axes.
    ///
    /// # Errors
    /// Why there is none, and what to do.
    pub(crate) fn arc_stated(
        &self,
        words: &Words,
        from: Vector3<f64>,
        to: Vector3<f64>,
    ) -> Result<Known, Reason> {
        let frame = &self.state.frame;
        if self.state.code == Code::Through {
            if words.via.iter().all(Option::is_none) {
                return Err(again("no point on the arc is stated (I1, J1, K1)"));
            }
            let via = Vector3::from_fn(|axis, _| match &words.via[axis] {
                Some(word) if word.step => from[axis] + word.mm,
                Some(word) => word.mm,
                None => from[axis],
            });
            let via = Target::Pose(self.pose(via));
            return Ok(Known {
                kind: MotionKind::Circular { via },
                end: to,
            });
        }
        let sense = match self.state.code {
            Code::Clockwise => -1.0,
            _ => 1.0,
        };
        let normal = self.state.normal;
        let has_end = words.has_axes();
        let found = arc(
            from,
            to,
            has_end,
            normal,
            sense,
            &words.stated_arc(self.state.unit_mm),
        )?;
        let mut axis = Vector3::zeros();
        axis[normal] = 1.0;
        Ok(Known {
            kind: MotionKind::Arc {
                centre_mm: (frame * Point3::from(found.centre)).coords,
                axis: frame.rotation * axis,
                angle_rad: found.angle_rad,
            },
            end: found.end,
        })
    }
}
