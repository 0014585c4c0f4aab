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
    match is_reserved(&name, language) {
        true => Err(MakeError::of_template(
            format!("`{name}` is a word of its own on controllers"),
            "name the program otherwise (program_name)",
        )),
        false => Ok(name),
    }
}

/// Words that no program of an arm has for a name, ...
const OF_ALL: &str = "DEF END MAIN MODULE PROC TOOL0 WOBJ0";

/// ... words of KRL (KUKA System Software, keywords), ...
const OF_KRL: &str = "AND ANIN ANOUT AXIS BAS BOOL BRAKE B_AND B_EXOR B_NOT B_OR CASE CAST_FROM CAST_TO CHANNEL CHAR CIRC CIRC_REL \
    CONFIRM CONST CONTINUE DECL DEFAULT DEFDAT DEFFCT DELAY DISTANCE DO E6AXIS E6POS ELSE ENDDAT ENDFCT ENDFOR \
    ENDIF ENDLOOP ENDSWITCH ENDWHILE ENUM EXIT EXOR EXT EXTFCT FALSE FOR FRAME GLOBAL GOTO HALT IF IMPORT INT \
    INTERRUPT IS LIN LIN_REL LOOP NOT OR POS PTP PTP_REL PUBLIC REAL REPEAT RESUME RETURN SIGNAL STRUC SWITCH THEN \
    TO TRIGGER SPLINE SPL SLIN SCIRC TRUE UNTIL WAIT WHILE";

/// ... and reserved words of RAPID and types (RAPID Overview of ABB, identifiers).
const OF_RAPID: &str = "ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF ENDMODULE ENDPROC \
    ENDRECORD ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD NOSTEPIN NOT NOVIEW \
    OR PERS RAISE READONLY RECORD RETRY RETURN STEP SYSMODULE TASK TEST THEN TO TRAP TRUE TRYNEXT UNDO VAR \
    VIEWONLY WHILE WITH XOR NUM BOOL STRING POSE";

/// Whether a name is a word of the language, or of one of its programs.
fn is_reserved(name: &str, language: MakeLanguage) -> bool {
    if language.limits().points.is_none() {
        return false;
    }
    let own = match language {
        MakeLanguage::Krl => OF_KRL,
        MakeLanguage::Rapid => OF_RAPID,
        _ => "",
    };
    let mut words = own.split_whitespace().chain(OF_ALL.split_whitespace());
    words.any(|word| name.eq_ignore_ascii_case(word))
}

/// Whether a text is an identifier of at most so many characters.
pub(crate) fn is_identifier(name: &str, most: usize, what: &str) -> Result<(), MakeError> {
    let shown: String = name.chars().take(80).filter(|c| !c.is_control()).collect();
    let right = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    if !begins || !name.chars().all(right) {
        return Err(MakeError::of_template(
            format!(
                "{what} is `{shown}`, and controllers take letters, digits and _, a letter first"
            ),
            "name it so: a program is called as its output, or as program_name in the template says",
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
