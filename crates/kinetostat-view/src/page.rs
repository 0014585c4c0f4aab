//! The page as one file.

/// The page: HTML with script, style and all. It asks the server from which it comes.
pub const PAGE: &str = include_str!("../bundle/index.html");

/// Element in which an exported page has its results.
const EMPTY: &str = r#"<script id="kinetostat-data" type="application/json"></script>"#;

/// The page with results in it (JSON): it needs no server. None if the page has no place for them, which a test rules out.
#[must_use]
pub fn exported(results: &str) -> Option<String> {
    let (before, after) = PAGE.split_once(EMPTY)?;
    let opened = EMPTY.strip_suffix("</script>")?;
    // Nothing in the results ends the element: in JSON, `<` stands in texts only.
    let results = results.replace('<', "\\u003c");
    Some(format!("{before}{opened}{results}</script>{after}"))
}
