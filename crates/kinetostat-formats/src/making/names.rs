//! Names, numbers and comments of made programs, as controllers take them.

use nalgebra::{UnitQuaternion, Vector3};

use crate::making::MakeError;
use crate::making::limits::MakeLanguage;
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::orientation::OrientationText;
use crate::rapid::table::{motion_row, row};
use crate::text::Name;

/// The name of the program where controllers take it.
pub(crate) fn checked(name: &str, language: MakeLanguage) -> Result<String, MakeError> {
    let most = language.limits().name;
    if matches!(language, MakeLanguage::Csv | MakeLanguage::Gcode) {
        return of_file(name, most);
    }
    let name = match language {
        MakeLanguage::FanucLs => name.to_ascii_uppercase(),
        _ => name.to_owned(),
    };
    is_identifier(&name, most, "the name of the program")?;
    match is_reserved(&name, language) {
        true => Err(MakeError::of_template(
            format!("`{name}` is a word of its own on controllers"),
            "name the program otherwise (program_name)",
        )),
        false => Ok(name),
    }
}

/// The name of a file that no controller calls by it.
fn of_file(name: &str, most: usize) -> Result<String, MakeError> {
    let strange = |c: char| c.is_control() || matches!(c, '/' | '\\');
    let shown: String = name.chars().take(80).filter(|c| !c.is_control()).collect();
    let found = match name.chars().count() {
        0 => "nothing".to_owned(),
        count if count > most => format!("`{shown}`, has {count} characters, {most} are allowed"),
        _ if name.contains(strange) => format!("`{shown}`, and no file is called so"),
        _ => return Ok(name.to_owned()),
    };
    Err(MakeError::of_template(
        format!("the name of the program is {found}"),
        NAMED_SO,
    ))
}

/// The longest name of a program in so many parts is one that controllers take, too.
pub(crate) fn parts_checked(
    name: &str,
    parts: usize,
    language: MakeLanguage,
) -> Result<(), MakeError> {
    let Some(last) = parts.checked_sub(1).filter(|last| *last > 0) else {
        return Ok(());
    };
    // The module of a part is called otherwise than its routine.
    let module = match language {
        MakeLanguage::Rapid => "m",
        _ => "",
    };
    let last = format!("{module}{}", of_part(name, last));
    let what = format!("the program becomes {parts} parts, and the name of the last");
    is_identifier(&last, language.limits().name, &what)
}

/// Names of a template that a module in RAPID cannot declare: words of the language, those of the module itself, and one for two things.
pub(crate) fn words_taken(template: &Template) -> Vec<MakeError> {
    let mut faults = Vec::new();
    let base = base_name(&template.base);
    let numbered = template
        .tools
        .iter()
        .map(|(number, tool)| (Some(*number), tool));
    // With several tools, the tool before the first change is only included if it is stated.
    let is_told = template.tools.is_empty() || template.tool != StatedTool::default();
    let tools = numbered.chain(is_told.then_some((None, &template.tool)));
    let of_tools = tools.map(|(number, tool)| (name_of_tool(number, tool), &tool.frame));
    let tools: Vec<(String, &StatedFrame)> = of_tools.collect();
    let of_base = [(base.clone(), &template.base)];
    let mut named: Vec<&str> = Vec::new();
    for (name, frame) in tools.iter().chain(&of_base) {
        if named.iter().any(|known| known.eq_ignore_ascii_case(name)) {
            continue;
        }
        named.push(name);
        if frame.name.is_some() && is_taken(name) {
            faults.push(MakeError::of_template(
                format!("`{name}` is a word of RAPID, or a name of the controller or the module"),
                "give tool or base another name",
            ));
        }
        if frame.pose.is_some() && name.eq_ignore_ascii_case(&template.program_name) {
            faults.push(MakeError::of_template(
                format!("the module is called `{name}`, as a tool or the base that it declares"),
                "name the program otherwise (its output, or program_name), or the tool or base",
            ));
        }
    }
    if tools
        .iter()
        .any(|(name, _)| name.eq_ignore_ascii_case(&base))
    {
        faults.push(MakeError::of_template(
            format!("a tool and the base are both called `{base}`"),
            "give each of them a name of its own",
        ));
    }
    faults
}

/// True if a name is reserved: words and instructions of RAPID, data that every controller has, and declarations of made modules.
fn is_taken(name: &str) -> bool {
    let letters = name.as_bytes();
    let known = Name::of(letters);
    let is_instruction =
        known.is_some_and(|name| motion_row(&name).is_some() || row(&name).is_some());
    let capitals = name.to_ascii_uppercase();
    let behind = |start: &str| {
        let rest = capitals.strip_prefix(start);
        rest.is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
    };
    // v100 and z10 are data of every controller.
    let is_datum = ["V", "Z", "VFEED"].into_iter().any(behind);
    let is_own = ["VRAPID", "VJOINT", "VMAX", "FINE", "LOAD0"].contains(&capitals.as_str());
    is_reserved(name, MakeLanguage::Rapid) || is_instruction || is_datum || is_own
}

/// Remedy of an invalid name.
const NAMED_SO: &str =
    "name it so: a program is called as its output, or as program_name in the template says";

/// Words that no program of an arm has for a name: words of KRL (KUKA System Software, keywords), ...
const OF_KRL: &str = "DEF END AND ANIN ANOUT AXIS BAS BOOL BRAKE B_AND B_EXOR B_NOT B_OR CASE CAST_FROM CAST_TO CHANNEL CHAR CIRC CIRC_REL \
    CONFIRM CONST CONTINUE DECL DEFAULT DEFDAT DEFFCT DELAY DISTANCE DO E6AXIS E6POS ELSE ENDDAT ENDFCT ENDFOR \
    ENDIF ENDLOOP ENDSWITCH ENDWHILE ENUM EXIT EXOR EXT EXTFCT FALSE FOR FRAME GLOBAL GOTO HALT IF IMPORT INT \
    INTERRUPT IS LIN LIN_REL LOOP NOT OR POS PTP PTP_REL PUBLIC REAL REPEAT RESUME RETURN SIGNAL STRUC SWITCH THEN \
    TO TRIGGER SPLINE SPL SLIN SCIRC TRUE UNTIL WAIT WHILE";

/// ... and reserved words of RAPID and types (RAPID Overview of ABB, identifiers).
const OF_RAPID: &str = "MAIN MODULE PROC TOOL0 WOBJ0 ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF ENDMODULE ENDPROC \
    ENDRECORD ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD NOSTEPIN NOT NOVIEW \
    OR PERS RAISE READONLY RECORD RETRY RETURN STEP SYSMODULE TASK TEST THEN TO TRAP TRUE TRYNEXT UNDO VAR \
    VIEWONLY WHILE WITH XOR NUM BOOL STRING POSE";

/// True if a name is a word of the language, or of one of its programs.
fn is_reserved(name: &str, language: MakeLanguage) -> bool {
    if language.limits().points.is_none() {
        return false;
    }
    let own = match language {
        MakeLanguage::Krl => OF_KRL,
        MakeLanguage::Rapid => OF_RAPID,
        _ => "",
    };
    own.split_whitespace()
        .any(|word| name.eq_ignore_ascii_case(word))
}

/// Checks that a text is an identifier with at most `most` characters.
pub(crate) fn is_identifier(name: &str, most: usize, what: &str) -> Result<(), MakeError> {
    let shown: String = name.chars().take(80).filter(|c| !c.is_control()).collect();
    let right = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    if !begins || !name.chars().all(right) {
        return Err(MakeError::of_template(
            format!(
                "{what} is `{shown}`, and controllers take letters, digits and _, a letter first"
            ),
            NAMED_SO,
        ));
    }
    if name.len() > most {
        return Err(MakeError::of_template(
            format!(
                "{what}, `{shown}`, has {} characters, {most} are allowed here",
                name.len()
            ),
            "give a shorter one: a program is called as its output, or as program_name in the template says",
        ));
    }
    Ok(())
}

/// The name of a part, counted from 0.
pub(crate) fn of_part(name: &str, part: usize) -> String {
    format!("{name}_{}", part + 1)
}

/// The name of a base.
pub(crate) fn base_name(base: &StatedFrame) -> String {
    let numbered = || format!("wobj{}", base.number.unwrap_or(1));
    base.name.clone().unwrap_or_else(numbered)
}

/// The name of a tool, with its number in the program.
pub(crate) fn name_of_tool(in_program: Option<u32>, tool: &StatedTool) -> String {
    let number = tool.frame.number.or(in_program).unwrap_or(1);
    tool.frame
        .name
        .clone()
        .unwrap_or_else(|| format!("tool{number}"))
}

pub(crate) use crate::text::number::{fixed, short};

/// The three coordinates.
pub(crate) fn coordinates(place: &Vector3<f64>, decimals: usize) -> [String; 3] {
    [0, 1, 2].map(|axis| fixed(place[axis], decimals))
}

/// The numbers of an orientation; angles within half a turn.
pub(crate) fn angles(
    orientation: &UnitQuaternion<f64>,
    text: OrientationText,
    decimals: usize,
) -> Vec<String> {
    let near = match text {
        OrientationText::Quaternion => vec![1.0, 1e-3, 1e-6, 1e-9],
        _ => vec![0.0; 3],
    };
    let numbers = text.numbers_of(orientation, &near);
    let half_turn = fixed(-180.0, decimals);
    let of_angle = |number: &f64| {
        let written = fixed(*number, decimals);
        // Half a turn backwards is half a turn.
        match text != OrientationText::Quaternion && written == half_turn {
            true => half_turn[1..].to_owned(),
            false => written,
        }
    };
    numbers.iter().map(of_angle).collect()
}

/// Longest text of a note, in characters.
const NOTE_CHARACTERS: usize = 120;

/// A text of the source as that of a comment: ASCII, in one line, without brackets that would end it.
pub(crate) fn plain(text: &str) -> String {
    let shown = text.chars().take(NOTE_CHARACTERS).map(|c| match c {
        '(' => '[',
        ')' => ']',
        '"' | ';' => ' ',
        ' '..='~' => c,
        '\t' => ' ',
        _ => '?',
    });
    let mut plain: String = shown.collect();
    if text.chars().count() > NOTE_CHARACTERS {
        plain.push_str("...");
    }
    plain.trim().to_owned()
}
