//! Checks of a template (ranges of numbers, required orientation), and findings on the frames of a made program.

use nalgebra::Isometry3;

use crate::ls::positions::is_configuration;
use crate::making::MakeError;
use crate::making::limits::MakeLanguage;
use crate::making::names::{angles, coordinates, is_identifier, words_taken};
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::orientation::OrientationText;

/// Beyond this a base is no place in a plant, mm.
const FARTHEST_BASE_MM: f64 = 1e6;

/// Beyond this from the flange no tip of a tool is, mm.
const LONGEST_TOOL_MM: f64 = 1e4;

/// Frames nearer than this are one.
const SAME_MM: f64 = 1e-6;
const SAME_RAD: f64 = 1e-9;

/// Everything that is wrong with a template.
pub(crate) fn faults(template: &Template, language: MakeLanguage) -> Vec<MakeError> {
    let mut faults = Vec::new();
    let mut within = |name: &str, value: f64, least: f64, most: f64| {
        if !(least..=most).contains(&value) {
            faults.push(MakeError::of_template(
                format!("{name} is {value}"),
                format!("{least} to {most} are allowed"),
            ));
        }
    };
    within(
        "rapid_speed_mm_per_s",
        template.rapid_speed_mm_per_s,
        0.001,
        10_000.0,
    );
    within(
        "joint_speed_percent",
        template.joint_speed_percent,
        0.1,
        100.0,
    );
    within("tolerance_mm", template.tolerance_mm, 1e-6, 10.0);
    if let Some(speed) = template.unstated_feed_mm_per_s {
        within("unstated_feed_mm_per_s", speed, 0.001, 10_000.0);
    }
    if let Some(acceleration) = template.acceleration_m_per_s2 {
        within("acceleration_m_per_s2", acceleration, 0.001, 100.0);
    }
    let zones = &template.zones;
    within("zones: rapids_mm", zones.rapids_mm, 0.0, 200.0);
    within("zones: feeds_mm", zones.feeds_mm, 0.0, 200.0);
    within("zones: rapids_percent", zones.rapids_percent, 0.0, 100.0);
    within("zones: feeds_percent", zones.feeds_percent, 0.0, 100.0);
    within(
        "position_decimals",
        template.position_decimals as f64,
        1.0,
        12.0,
    );
    within("angle_decimals", template.angle_decimals as f64, 1.0, 12.0);
    within(
        "quaternion_decimals",
        template.quaternion_decimals as f64,
        3.0,
        15.0,
    );
    if let Some(decimals) = template.speed_decimals {
        within("speed_decimals", decimals as f64, 0.0, 12.0);
    }
    if let (Some(stated), Some((_, most))) = (template.most_points, language.limits().points) {
        within("most_points", stated as f64, 2.0, most as f64);
    }
    for joint in template.start_joints_deg.iter().flatten() {
        within("start_joints_deg", *joint, -10_000.0, 10_000.0);
    }
    if template
        .start_joints_deg
        .as_ref()
        .is_some_and(|joints| joints.len() != 6)
    {
        faults.push(MakeError::of_template(
            "start_joints_deg has not six values",
            "state six joints; further axes are not written",
        ));
    }
    let tools = template.tools.values().chain([&template.tool]);
    for tool in tools {
        faults.extend(of_tool(tool, language));
    }
    faults.extend(of_frame(&template.base, "base", language));
    if language == MakeLanguage::Rapid {
        faults.extend(words_taken(template));
    }
    faults.extend(of_configuration(template, language));
    let spindle = &template.spindle;
    let lines = spindle.clockwise.iter().chain(&spindle.counter_clockwise);
    let lines = lines.chain(&spindle.stop);
    let foreign = lines.filter(|line| is_foreign(line, language));
    faults.extend(foreign.map(|line| foreign_statement(&format!("`{line}` is not"), language)));
    faults
}

/// True if only another controller writes a statement in this form.
fn is_foreign(line: &str, language: MakeLanguage) -> bool {
    let line = line.to_ascii_uppercase().replace(' ', "");
    let sets = |values: [&str; 2]| values.iter().any(|value| line.ends_with(value));
    match language {
        MakeLanguage::Krl => line.ends_with(';') || sets(["=ON", "=OFF"]),
        MakeLanguage::Rapid => !line.ends_with(';') && !line.starts_with('!'),
        MakeLanguage::FanucLs => line.starts_with("$OUT[") || sets(["=TRUE", "=FALSE"]),
        _ => false,
    }
}

/// Statements of the spindle that are not of the language.
pub(crate) fn foreign_statement(which: &str, language: MakeLanguage) -> MakeError {
    let (title, example) = match language {
        MakeLanguage::Rapid => ("RAPID", "SetDO doSpindle, 1;"),
        MakeLanguage::FanucLs => ("TP", "DO[5]=ON"),
        _ => ("KRL", "$OUT[12]=TRUE"),
    };
    MakeError::of_template(
        format!("[spindle]: {which} a statement of {title}"),
        format!(
            "write it as its controller has it, such as `{example}`, or give the template of that cell"
        ),
    )
}

pub(crate) fn of_tool(tool: &StatedTool, language: MakeLanguage) -> Vec<MakeError> {
    let mut faults = of_frame(&tool.frame, "tool", language);
    if tool.mass_kg.is_some_and(|mass| !is_mass(mass)) {
        faults.push(MakeError::of_template(
            "mass_kg of a tool is not from 0.001 to 5000",
            "state the mass in kg",
        ));
    }
    faults
}

/// True if a mass is plausible for a tool, kg.
pub(crate) fn is_mass(mass_kg: f64) -> bool {
    (1e-3..=5000.0).contains(&mass_kg)
}

pub(crate) fn of_frame(frame: &StatedFrame, what: &str, language: MakeLanguage) -> Vec<MakeError> {
    let mut faults = Vec::new();
    if let Some(name) = &frame.name {
        let most = MakeLanguage::Rapid.limits().name;
        faults.extend(is_identifier(name, most, &format!("the name of the {what}")).err());
        if language != MakeLanguage::Rapid {
            faults.push(MakeError::of_template(
                format!("the {what} has a name, which RAPID alone has"),
                "state its number, or its pose",
            ));
        }
    }
    let farthest = match what {
        "tool" => LONGEST_TOOL_MM,
        _ => FARTHEST_BASE_MM,
    };
    let position = frame.pose.as_ref().map(|pose| pose.translation.vector);
    let too_far = |value: &&f64| value.is_nan() || value.abs() > farthest;
    if let Some(value) = position.iter().flatten().find(too_far) {
        faults.push(MakeError::of_template(
            format!("pose of the {what}: position_mm has {value:e}, farther than {farthest} mm"),
            "check the number and its unit, mm",
        ));
    }
    let is_elsewhere = frame.pose.as_ref().is_some_and(|pose| !is_identity(pose));
    if has_own_zero(language) && is_number_zero(frame) && is_elsewhere {
        faults.push(MakeError::of_template(
            format!(
                "the {what} has the number 0, which is {} on the controller and cannot be set, and its pose is another",
                match what {
                    "tool" => "the flange",
                    _ => "the world frame",
                }
            ),
            "state another number, or leave the pose out",
        ));
    }
    let most = match (language, what) {
        (MakeLanguage::FanucLs, "tool") => 29,
        (MakeLanguage::FanucLs, _) => 61,
        _ => 255,
    };
    if frame.number.is_some_and(|number| number > most) {
        faults.push(MakeError::of_template(
            format!("the number of the {what} is above {most}"),
            "state that of the controller",
        ));
    }
    faults
}

/// True if frame 0 belongs to the controller and cannot be defined by the user: wobj0 and tool0, UF 0 and UT 0. KRL writes poses.
pub(crate) fn has_own_zero(language: MakeLanguage) -> bool {
    matches!(language, MakeLanguage::Rapid | MakeLanguage::FanucLs)
}

/// True if a frame has the number 0, and no name.
pub(crate) fn is_number_zero(frame: &StatedFrame) -> bool {
    frame.number == Some(0) && frame.name.is_none()
}

/// True if a pose is the identity: that of the world, or of the flange.
pub(crate) fn is_identity(pose: &Isometry3<f64>) -> bool {
    pose.translation.vector.norm() < SAME_MM && pose.rotation.angle() < SAME_RAD
}

/// A configuration stands in the program as it is stated.
fn of_configuration(template: &Template, language: MakeLanguage) -> Option<MakeError> {
    let text = template.configuration.as_ref()?;
    let (form, right) = match language {
        MakeLanguage::Krl => (
            "\"S 2, T 35\" here, S from 0 to 31 (bits 0 to 2 say how the arm bends) and T from 0 to 63",
            is_status_and_turn(text),
        ),
        MakeLanguage::Rapid => ("\"[0,-1,0,0]\" here", is_four_numbers(text)),
        MakeLanguage::FanucLs => ("\"N U T, 0, 0, 0\" here", is_configuration(text)),
        _ => return None,
    };
    (!right).then(|| {
        let shown: String = text.chars().take(40).filter(|c| !c.is_control()).collect();
        MakeError::of_template(
            format!("the configuration is `{shown}`"),
            format!("it is written as {form}"),
        )
    })
}

fn is_status_and_turn(text: &str) -> bool {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let number = |part: &str, letter: char, most: u32| {
        let rest = part.strip_prefix(letter).map(str::trim);
        rest.is_some_and(|rest| {
            let digits = rest.len() <= 3 && rest.bytes().all(|b| b.is_ascii_digit());
            digits && rest.parse().is_ok_and(|value: u32| value <= most)
        })
    };
    // S has five bits at most, T one for each of six axes.
    matches!(parts[..], [s, t] if number(s, 'S', 31) && number(t, 'T', 63))
}

fn is_four_numbers(text: &str) -> bool {
    let inside = text
        .trim()
        .strip_prefix('[')
        .and_then(|text| text.strip_suffix(']'));
    let numbers = inside.map(|inside| {
        inside
            .split(',')
            .map(|part| part.trim().parse::<i32>().ok())
            .collect()
    });
    numbers.is_some_and(|numbers: Vec<Option<i32>>| {
        numbers.len() == 4 && numbers.iter().all(Option::is_some)
    })
}

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
