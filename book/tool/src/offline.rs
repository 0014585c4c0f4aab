//! No page loads anything from the network. Links that a reader may click are allowed.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};

/// Looks at every page and style sheet; returns the number of pages.
///
/// # Errors
/// The first reference to the network, with its page.
pub fn check(folder: &Path) -> Result<usize> {
    let mut pages = 0;
    for entry in fs::read_dir(folder).with_context(|| format!("{}", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            pages += check(&path)?;
            continue;
        }
        let kind = path.extension().and_then(|e| e.to_str());
        if !matches!(kind, Some("html" | "css" | "svg")) {
            continue;
        }
        let text = fs::read_to_string(&path).with_context(|| format!("{}", path.display()))?;
        if let Some(found) = loaded_from_network(&text) {
            bail!("{} loads from the network: {found}", path.display());
        }
        pages += usize::from(kind == Some("html"));
    }
    Ok(pages)
}

/// The first thing that a browser would load from the network by itself.
fn loaded_from_network(text: &str) -> Option<&str> {
    const LOADS: [&str; 5] = ["src=", "srcset=", "data=", "url(", "@import"];
    for (at, _) in text.match_indices("//") {
        let before = text[..at].trim_end_matches(['h', 't', 'p', 's', ':']);
        let before = before.trim_end_matches(['"', '\'', ' ']);
        let tag = before.rfind('<').map_or("", |i| &before[i..]);
        let link = before.ends_with("href=") && !tag.starts_with("<a ") && !tag.contains('>');
        if link || LOADS.iter().any(|l| before.ends_with(l)) {
            let end = text[at..]
                .find(['"', '\'', ')', '>'])
                .map_or(text.len(), |e| at + e);
            return Some(&text[before.len()..end]);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::loaded_from_network;

    #[test]
    fn what_loads_is_found_and_links_are_not() {
        for loads in [
            "<script async src=\"https://x.org/a.js\"></script>",
            "<link rel=\"stylesheet\" href='http://x.org/a.css'>",
            "<img src=\"//x.org/a.png\">",
            "@import \"https://x.org/a.css\";",
            "a { background: url(https://x.org/a.png) }",
        ] {
            assert!(loaded_from_network(loads).is_some(), "{loads}");
        }
        for harmless in [
            "<a class=\"x\" href=\"https://x.org\">x</a>",
            "<svg xmlns=\"http://www.w3.org/2000/svg\">",
            "// a comment",
            "<p>see https://x.org</p>",
        ] {
            assert_eq!(loaded_from_network(harmless), None, "{harmless}");
        }
    }
}
