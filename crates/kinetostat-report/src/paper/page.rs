//! A paper as HTML.

use std::fmt::Write;

use crate::paper::block::{Block, Cell, Contents, Side, Table};
use crate::run::meaning::class;
use crate::svg::picture_address;
use crate::text::escape;

const STYLE: &str = "body{font:15px/1.45 'Noto Sans','Segoe UI',Arial,sans-serif;max-width:52em;margin:2em auto;padding:0 1em;color:#111;background:#fff}\
h1{font-size:1.5em}h1 small{display:block;font-size:.6em;color:#555;font-weight:normal}h2{font-size:1.1em;margin-top:1.8em}\
.box{border:1px solid #888;border-left:6px solid #888;padding:.6em 1em}.good{border-left-color:#1a7f37}.attention{border-left-color:#b35900}.stop{border-left-color:#b00020}\
dl{display:grid;grid-template-columns:14em 1fr;gap:.2em 1em}dt{color:#555}dd{margin:0;overflow-wrap:anywhere}dd span{display:block}\
table{border-collapse:collapse;width:100%;font-size:.9em}th,td{text-align:left;padding:.2em .5em;border-bottom:1px solid #ccc;vertical-align:top;overflow-wrap:anywhere}\
img{display:block;width:100%;margin:1em 0;color-scheme:light}.right{text-align:right}.whole{white-space:nowrap;overflow-wrap:normal}.note{color:#555;font-size:.9em}.sign{margin-top:2.5em;border-top:1px solid #111;padding-top:.2em}\
@media print{h2{break-after:avoid}tr,.box{break-inside:avoid}}";

/// The page; every text is escaped.
pub(crate) fn html(contents: &Contents) -> String {
    let date = contents.date.iter().map(|date| {
        let day = escape(date);
        format!("<meta name=\"dcterms.date\" content=\"{day}\">\n")
    });
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n{}<title>{}</title>\n<style>{STYLE}{}</style>\n</head>\n<body>\n<h1><small>{}</small>{}</h1>\n",
        contents.language.code(),
        date.collect::<String>(),
        escape(&contents.title),
        numbered_pages(contents.page_of),
        escape(&contents.kind),
        escape(&contents.title)
    );
    for part in &contents.blocks {
        block(&mut out, part);
    }
    let [_, made_by] = &contents.running;
    out.push_str(&format!(
        "<p class=\"note\">{}</p>\n</body>\n</html>\n",
        escape(made_by)
    ));
    out
}

/// Pages are numbered where they are printed, as in the PDF: `page {page} of {pages}` with the browser's counters.
fn numbered_pages(page_of: &str) -> String {
    let counted = page_of
        .replace("{pages}", "\" counter(pages) \"")
        .replace("{page}", "\" counter(page) \"");
    format!("@page{{@bottom-right{{content:\"{counted}\"}}}}")
}

fn block(out: &mut String, block: &Block) {
    // Writing to a string cannot fail.
    let _ = match block {
        Block::Heading(text) => writeln!(out, "<h2>{}</h2>", escape(text)),
        Block::Paragraph(text) => writeln!(out, "<p>{}</p>", escape(text)),
        Block::Note(text) => writeln!(out, "<p class=\"note\">{}</p>", escape(text)),
        Block::Verdict {
            level,
            word,
            sentences,
        } => writeln!(
            out,
            "<div class=\"box {}\"><strong>{}</strong>{}</div>",
            class(*level),
            escape(word),
            each(sentences, "p")
        ),
        Block::Facts(facts) => {
            let all = facts.iter().map(|(name, lines)| {
                format!(
                    "<dt>{}</dt><dd>{}</dd>\n",
                    escape(name),
                    each(lines, "span")
                )
            });
            writeln!(out, "<dl>\n{}</dl>", all.collect::<String>())
        }
        Block::Remarks(remarks) => {
            let all = remarks.iter().map(|r| {
                format!(
                    "<dt>{}</dt><dd><strong>{}</strong> {}</dd>\n",
                    escape(&r.name),
                    escape(&r.size),
                    escape(&r.text)
                )
            });
            writeln!(out, "<dl>\n{}</dl>", all.collect::<String>())
        }
        Block::List(items) => writeln!(out, "<ul>{}</ul>", each(items, "li")),
        Block::Picture { svg, shows } => writeln!(
            out,
            "<img alt=\"{}\" src=\"{}\">",
            escape(shows),
            picture_address(svg)
        ),
        Block::Table(table) => writeln!(out, "{}", rows(table)),
        Block::Signatures(all) => {
            let lines = all.iter().map(|[who, name, signature]| {
                format!(
                    "<p class=\"sign\"><strong>{}</strong>: {}; {}</p>\n",
                    escape(who),
                    escape(name),
                    escape(signature)
                )
            });
            writeln!(out, "{}", lines.collect::<String>())
        }
    };
}

fn each(texts: &[String], element: &str) -> String {
    let all = texts
        .iter()
        .map(|text| format!("<{element}>{}</{element}>", escape(text)));
    all.collect()
}

fn rows(table: &Table) -> String {
    let class = |at: usize| match table.columns.get(at).map(|c| (c.side, c.wraps)) {
        Some((Side::Right, false)) => " class=\"right whole\"",
        Some((Side::Right, true)) => " class=\"right\"",
        Some((Side::Left, false)) => " class=\"whole\"",
        Some((Side::Left, true)) | None => "",
    };
    let heads = table.columns.iter().enumerate();
    let heads: String = heads
        .map(|(at, column)| format!("<th{}>{}</th>", class(at), escape(&column.head)))
        .collect();
    let cell = |(at, cell): (usize, &Cell)| {
        let text = escape(&cell.text);
        match cell.strong {
            true => format!("<td{}><strong>{text}</strong></td>", class(at)),
            false => format!("<td{}>{text}</td>", class(at)),
        }
    };
    let body = table.rows.iter().map(|row| {
        let cells: String = row.iter().enumerate().map(cell).collect();
        format!("<tr>{cells}</tr>\n")
    });
    format!(
        "<table><thead><tr>{heads}</tr></thead><tbody>\n{}</tbody></table>",
        body.collect::<String>()
    )
}
