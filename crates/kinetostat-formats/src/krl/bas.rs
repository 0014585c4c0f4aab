//! BAS, by which inline forms put in force what their data state: `BAS(#CP_PARAMS,0.2)`.

use std::ops::Range;

use crate::interpreter::run::Reason;
use crate::krl::expression::expression_of;
use crate::krl::moving_settings::{EXTERNAL_TOOL, TAKE_OUT};
use crate::krl::role::Role;
use crate::krl::state::Run;

impl Run<'_, '_> {
    /// `BAS(#COMMAND,value)`: tokens of the whole call.
    pub(super) fn bas(&mut self, tokens: &Range<usize>) -> Result<(), Reason> {
        let file = self.file();
        let is_command = file.is(tokens.start + 1, b'(') && file.is(tokens.start + 2, b'#');
        let command = is_command.then(|| file.name(tokens.start + 3)).flatten();
        let comma = file.find(tokens.start + 2..tokens.end, b',');
        let close = file
            .find(tokens.start + 2..tokens.end, b')')
            .unwrap_or(tokens.end);
        let value = comma.map_or(close..close, |comma| comma + 1..close);
        let number = match value.is_empty() {
            true => None,
            false => self.value(&expression_of(file, value.clone())).as_number(),
        };
        let Some(command) = command else {
            self.own.force.forget();
            return Ok(());
        };
        let linear_mm = self.own.force.linear_mm;
        match command.letters() {
            b"CP_PARAMS" | b"PTP_PARAMS" | b"FRAMES" => {
                self.frames_of_point()?;
                if command.is("CP_PARAMS") {
                    self.set_speed(number, file.text(tokens));
                    self.own.force.distance_mm = linear_mm;
                } else if command.is("PTP_PARAMS") {
                    self.own.force.joint_percent = self.own.force.joint;
                }
            }
            b"TOOL" | b"BASE" => {
                let role = match command.is("TOOL") {
                    true => Role::Tool,
                    false => Role::Base,
                };
                let frame = match number.filter(|number| *number >= 0.0) {
                    Some(number) => Some(self.numbered(role, number as u32)),
                    None if value.is_empty() => None,
                    None => Some(self.computed(role, &file.text(&value))),
                };
                match role {
                    Role::Base => self.own.force.base = frame,
                    Role::Tool => self.own.force.tool = frame,
                }
            }
            b"VEL_CP" => self.set_speed(number, file.text(tokens)),
            b"CP_DAT" => {
                self.own.force.speed = None;
                self.own.force.distance_mm = linear_mm;
            }
            b"PTP_DAT" => self.own.force.joint_percent = self.own.force.joint,
            b"VEL_PTP" | b"ACC_CP" | b"ACC_PTP" | b"OUT_SYNC" | b"OUT_ASYNC" | b"GROUP" => {}
            _ => {
                self.own.force.forget();
                if command.is("INITMOV") {
                    self.own.force.keeps_orientation = false;
                }
            }
        }
        Ok(())
    }

    fn frames_of_point(&mut self) -> Result<(), Reason> {
        let point = self.own.force.point;
        if point.is_some_and(|point| point.is_external) {
            return Err((EXTERNAL_TOOL.to_owned(), TAKE_OUT));
        }
        let tool = point.and_then(|point| point.tool);
        let base = point.and_then(|point| point.base);
        self.own.force.tool = tool.map(|number| self.numbered(Role::Tool, number));
        self.own.force.base = base.map(|number| self.numbered(Role::Base, number));
        Ok(())
    }
}
