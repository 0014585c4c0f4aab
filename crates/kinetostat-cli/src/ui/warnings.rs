//! Warnings as a list.

use crate::ui::layout::item;

/// Warnings as a list, or nothing.
pub(crate) fn warnings<W: std::fmt::Display>(list: &[W]) -> String {
    const SHOWN: usize = 8;
    if list.is_empty() {
        return String::new();
    }
    let mut out = format!(
        "\n{}\n",
        match list.len() {
            1 => "Warning".to_owned(),
            n => format!("{n} warnings"),
        }
    );
    for warning in list.iter().take(SHOWN) {
        out.push_str(&item(&warning.to_string()));
    }
    if list.len() > SHOWN {
        out.push_str(&format!(
            "  and {} more; the report and the JSON have them all\n",
            list.len() - SHOWN
        ));
    }
    out
}
