//! Every page can be searched: the index that the pages load names them all.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use mdbook_driver::book::Book;

/// Looks the book's chapters up in the index beside the pages.
///
/// # Errors
/// No index, or a chapter that it lacks.
pub fn check(folder: &Path, book: &Book) -> Result<()> {
    let path = folder.join("searchindex.js");
    let index = fs::read_to_string(&path).with_context(|| format!("{}", path.display()))?;
    for chapter in book.chapters() {
        let Some(source) = &chapter.path else {
            continue;
        };
        let page = source.with_extension("html").display().to_string();
        if !holds(&index, &page) {
            bail!("{} does not hold {page}", path.display());
        }
    }
    Ok(())
}

/// Whether an index names a page, or a heading of it.
fn holds(index: &str, page: &str) -> bool {
    index.contains(&format!("\"{page}#")) || index.contains(&format!("\"{page}\""))
}

#[cfg(test)]
mod tests {
    use super::holds;

    #[test]
    fn pages_are_found_by_their_headings() {
        let index = r#"["tutorials/buckling.html#the-curve","cost.html"]"#;
        assert!(holds(index, "tutorials/buckling.html") && holds(index, "cost.html"));
        assert!(!holds(index, "buckling.html") && !holds(index, "design.html"));
    }
}
