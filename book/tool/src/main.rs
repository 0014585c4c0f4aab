//! Builds the book beside it: mdBook, formulas turned into MathML beforehand, nothing from the
//! network in the result. `cargo xtask book` calls it.

mod formulas;
mod offline;
mod search;

use std::path::Path;
use std::process::ExitCode;

use anyhow::Result;
use mdbook_driver::MDBook;

use formulas::Formulas;

fn main() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("book: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<()> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut book = MDBook::load(own.parent().unwrap_or(own))?;
    book.with_preprocessor(Formulas);
    book.build()?;
    let built = book.build_dir_for("html");
    let pages = offline::check(&built)?;
    search::check(&built, &book.book)?;
    println!(
        "{pages} pages, all in the index of the search, no reference to the network: {}",
        built.join("index.html").display()
    );
    Ok(())
}
