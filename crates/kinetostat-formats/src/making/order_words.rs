//! Statements that only order a program: nothing of it is lost without them.

use crate::model::language::Language;

/// Words with which lines begin that only order a program: nothing of it is lost.
fn of_form(language: Language) -> &'static [&'static str] {
    match language {
        Language::Rapid => &[
            "MODULE",
            "ENDMODULE",
            "PROC",
            "ENDPROC",
            "CONST",
            "PERS",
            "VAR",
            "LOCAL",
            "TASK",
            "%%%",
            "VERSION",
            "LANGUAGE",
            // How the tool turns is followed.
            "CIRPATHMODE",
            "SINGAREA",
        ],
        Language::Krl => &[
            "&",
            "DEF",
            "DEFFCT",
            "DEFDAT",
            "END",
            "ENDFCT",
            "ENDDAT",
            "ENDIF",
            "ENDLOOP",
            "ENDFOR",
            "ENDWHILE",
            "ENDSWITCH",
            "DECL",
            ";FOLD",
            ";ENDFOLD",
            "; ENDFOLD",
            "INI",
            "$BASE",
            "$TOOL",
            "$VEL",
            "$APO",
            "PDAT_ACT",
            "FDAT_ACT",
            "LDAT_ACT",
            "BAS",
            "BASE_DATA",
            "TOOL_DATA",
            "$BWDSTART",
            "EXT",
            "EXTFCT",
            "INT ",
            "REAL ",
            "BOOL ",
            "E6POS ",
            "FRAME ",
            "POS ",
            "$ACC",
            // Followed, or refused where the tool would go or turn otherwise.
            "SPLINE",
            "ENDSPLINE",
            "$IPO_MODE",
            "$ORI_TYPE",
            "$CIRC_TYPE",
            "$CIRC_MODE",
        ],
        Language::FanucLs => &["/", "UFRAME_NUM", "UTOOL_NUM"],
        Language::Apt => &[
            "GOTO", "RAPID", "FEDRAT", "UNITS", "UNIT", "MULTAX", "TLAXIS", "PARTNO", "TRNTYP",
            "FINI", "END",
        ],
        // Their words are looked at one by one.
        Language::Heidenhain | Language::Siemens => &[],
        // Rows and keys state poses; the rest of a list goes with its pose.
        Language::Poses => &[""],
    }
}

/// Whether a statement only orders its program: nothing of it is lost.
pub(crate) fn orders_only(language: Language, statement: &str) -> bool {
    let upper = statement.to_ascii_uppercase();
    of_form(language).iter().any(|word| begins(&upper, word))
}

/// Whether a statement begins with a word as a whole; what begins with a sign may go on.
fn begins(statement: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let is_whole = word.starts_with('$') || !word.ends_with(is_part);
    let behind = statement.strip_prefix(word);
    behind.is_some_and(|rest| is_whole || !rest.starts_with(is_part))
}
