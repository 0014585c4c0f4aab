//! Findings on the frames of a made program.

use nalgebra::Isometry3;

use crate::making::limits::MakeLanguage;
use crate::making::numbers::{angles, coordinates};
use crate::making::stated::is_number_zero;
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::orientation::OrientationText;

/// Reports the frames in use, and the place where they have to be set.
pub(crate) fn of_frames(template: &Template, language: MakeLanguage, say: &mut impl FnMut(String)) {
    let base_number = template.base.number.unwrap_or(1);
    let tool = &template.tool.frame;
    let several = !template.tools.is_empty();
    match language {
        MakeLanguage::FanucLs => frames_of_controller(template, say),
        _ => {
            if template.base.pose.is_none() {
                let name = match (language, &template.base.name) {
                    (_, Some(name)) => name.clone(),
                    (MakeLanguage::Rapid, None) => format!("wobj{base_number}"),
                    _ => format!("BASE_DATA[{base_number}]"),
                };
                say(format!(
                    "where the part is, is not stated: {name} of the controller counts"
                ));
            }
            if tool.pose.is_none() && !several {
                let number = tool.number.unwrap_or(1);
                let name = match (language, &tool.name) {
                    (_, Some(name)) => name.clone(),
                    (MakeLanguage::Rapid, None) => format!("tool{number}"),
                    _ => format!("TOOL_DATA[{number}]"),
                };
                say(format!(
                    "where the tool's tip is, is not stated: {name} of the controller counts"
                ));
            }
        }
    }
    let declared = |tool: &&StatedTool| tool.frame.pose.is_some() && !is_number_zero(&tool.frame);
    let tools = template.tools.values();
    let tools: Vec<&StatedTool> = match several {
        true => tools.filter(declared).collect(),
        false => std::iter::once(&template.tool).filter(declared).collect(),
    };
    if language == MakeLanguage::Rapid && tools.iter().any(|tool| tool.mass_kg.is_none()) {
        say(match several {
            true => "the mass of a tool is not stated: 1 kg is written".to_owned(),
            false => "the mass of the tool is not stated: 1 kg is written".to_owned(),
        });
    }
}

/// A program in LS holds the numbers of its frames alone: what they are has to be set at the controller.
fn frames_of_controller(template: &Template, say: &mut impl FnMut(String)) {
    let six = |frame: &Isometry3<f64>| {
        let [x, y, z] = coordinates(&frame.translation.vector, template.position_decimals);
        let decimals = template.angle_decimals;
        let turn = angles(&frame.rotation, OrientationText::Wpr, decimals).into_iter();
        let turn: Vec<String> = ["W", "P", "R"]
            .iter()
            .zip(turn)
            .map(|(name, angle)| format!("{name} {angle}"))
            .collect();
        format!("X {x}, Y {y}, Z {z} mm, {} deg", turn.join(", "))
    };
    let number = template.base.number.unwrap_or(1);
    say(match (number, &template.base.pose) {
        (0, _) => "user frame 0 is the world frame of the robot, which cannot be set: the places are in its axes".to_owned(),
        (_, Some(pose)) => format!(
            "user frame {number} is that of the controller: set it there to {}, as it was stated in the robot's axes",
            six(pose)
        ),
        (_, None) => format!(
            "user frame {number} is that of the controller: set it there to where the part is"
        ),
    });
    let tools: Vec<&StatedFrame> = match template.tools.is_empty() {
        true => vec![&template.tool.frame],
        false => template.tools.values().map(|tool| &tool.frame).collect(),
    };
    for tool in tools.into_iter().filter(|tool| !is_number_zero(tool)) {
        let number = tool.number.unwrap_or(1);
        say(match &tool.pose {
            Some(pose) => format!(
                "tool frame {number} is that of the controller: set it there to {}, in axes of the flange",
                six(pose)
            ),
            None => format!(
                "tool frame {number} is that of the controller: set it there to where the tip is"
            ),
        });
    }
}
