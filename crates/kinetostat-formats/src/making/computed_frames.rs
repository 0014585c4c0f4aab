//! Tools and work objects of which the run alone knows which they are.

use crate::making::fault::MakeError;
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::frame::{Frame, FrameUse};
use crate::model::language::Language;
use crate::model::program::RobotProgram;

/// Each, by the line of its first motion, where the template does not say what it is.
pub(crate) fn computed_frames(program: &RobotProgram, template: &Template) -> Vec<MakeError> {
    let of_source = [
        template.tool == StatedTool::default() && template.tools.is_empty(),
        template.base == StatedFrame::default(),
    ];
    let mut named: Vec<&str> = Vec::new();
    let mut faults = Vec::new();
    for motion in &program.motions {
        let uses = [
            ("tool", "[tool]", &motion.tool),
            ("work object", "[base]", &motion.work_object),
        ];
        for ((what, key, used), _) in uses.into_iter().zip(of_source).filter(|(_, own)| *own) {
            let Frame::Unknown { reason } = &used.frame else {
                continue;
            };
            if !is_computed(program.language, used) || named.contains(&used.name.as_str()) {
                continue;
            }
            named.push(&used.name);
            faults.push(MakeError::at(
                motion.line,
                format!("which {what} `{}` is, is not known: {reason}", used.name),
                format!("write its number, or state it in the template under {key}"),
            ));
        }
    }
    faults
}

/// An element of an array whose index is no number, or the value of an expression or of a variable.
fn is_computed(language: Language, used: &FrameUse) -> bool {
    let name = used.name.as_str();
    let Some((_, inside)) = name.split_once(['[', '{', '(']) else {
        // Without an assignment to $TOOL and $BASE, the controller's frames are valid.
        return language.numbers_frames() && !name.starts_with('$');
    };
    let index = inside.trim_end_matches([']', '}', ')']);
    index.trim().parse::<u32>().is_err()
}
