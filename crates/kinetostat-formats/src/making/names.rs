//! Names of programs and data, as controllers take them.

use crate::making::fault::MakeError;
use crate::making::limits::MakeLanguage;

/// Room for the number of a part behind a name: `_999`.
const PART: usize = 4;

/// The name of the program where controllers take it.
pub(crate) fn checked(name: &str, language: MakeLanguage) -> Result<String, MakeError> {
    let most = language.limits().name;
    let most = match language.limits().points {
        Some(_) => most - PART,
        None => most,
    };
    let name = match language {
        MakeLanguage::FanucLs => name.to_ascii_uppercase(),
        _ => name.to_owned(),
    };
    is_identifier(&name, most, "the name of the program")?;
    let reserved = ["DEF", "END", "MAIN", "MODULE", "PROC", "TOOL0", "WOBJ0"];
    match language.limits().points.is_some()
        && reserved.iter().any(|r| name.eq_ignore_ascii_case(r))
    {
        true => Err(MakeError::of(
            format!("`{name}` is a word of its own on controllers"),
            "name the program otherwise (program_name)",
        )),
        false => Ok(name),
    }
}

/// Whether a text is an identifier of at most so many characters.
pub(crate) fn is_identifier(name: &str, most: usize, what: &str) -> Result<(), MakeError> {
    let shown: String = name.chars().take(80).filter(|c| !c.is_control()).collect();
    let right = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    if !begins || !name.chars().all(right) {
        return Err(MakeError::of(
            format!(
                "{what} is `{shown}`, and controllers take letters, digits and _, a letter first"
            ),
            "name it so: a program is called as its output, or as program_name in the template says",
        ));
    }
    if name.len() > most {
        return Err(MakeError::of(
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
