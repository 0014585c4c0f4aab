//! Numbers as they are written.

/// A number with up to nine decimals: far below a nanometre, in inches and behind many steps, too.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.9}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}
