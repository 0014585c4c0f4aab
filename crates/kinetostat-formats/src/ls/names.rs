//! Names that people give positions: `P[3:"corner"]` in the section `/POS`, `P[3:corner]` in a motion.

use std::collections::BTreeMap;

use crate::model::motion::Motion;
use crate::text::source::SourceFile;

/// Number and name in `P[3:"corner"]`, with which a text begins; none without a name.
fn named(text: &str) -> Option<(u32, &str)> {
    let inside = text.strip_prefix("P[")?;
    let end = inside.find(']')?;
    let (number, name) = inside[..end].split_once(':')?;
    let name = name.trim().trim_matches('"').trim();
    Some((number.trim().parse().ok()?, name)).filter(|_| !name.is_empty())
}

/// The names of the positions of a program.
pub(crate) fn position_names(source: &SourceFile) -> BTreeMap<u32, String> {
    let lines = (1..=source.line_count()).filter_map(|line| source.line(line));
    let heads = lines
        .map(<[u8]>::trim_ascii)
        .filter(|line| line.starts_with(b"P[") && line.ends_with(b"{"));
    let named = heads.filter_map(|line| {
        let text = String::from_utf8_lossy(line);
        let (number, name) = named(&text)?;
        Some((number, name.to_owned()))
    });
    named.collect()
}

/// Name of the end of a motion of a TP program: `P[3]: corner`.
pub(crate) fn named_end(
    source: &SourceFile,
    motion: &Motion,
    names: &BTreeMap<u32, String>,
) -> Option<String> {
    let text = String::from_utf8_lossy(source.part(&motion.site.target_span));
    if let Some((number, name)) = named(&text) {
        return Some(format!("P[{number}]: {name}"));
    }
    let number = text.strip_prefix("P[")?.split([']', ':']).next()?;
    let number: u32 = number.trim().parse().ok()?;
    Some(format!("P[{number}]: {}", names.get(&number)?))
}
