//! Tables of spreadsheets in German or French: semicolons between cells and decimal commas.

use std::borrow::Cow;
use std::path::Path;

use kinetostat_links::Text;

use crate::ui::failure::Answer;

/// A table with commas between cells and decimal points, line for line; any other text as it is.
///
/// The first row decides: only where it has semicolons between its cells is a comma part of a number.
pub(crate) fn with_decimal_points(text: &str) -> Cow<'_, str> {
    let is_row = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let head = text.lines().find(is_row);
    if !head.is_some_and(|head| head.contains(';') && !head.contains('"')) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        // A cell in quotation marks may hold a semicolon: readers name what they cannot read.
        if !is_row(&line) || line.contains('"') {
            out.push_str(line);
            continue;
        }
        let row = line.trim_end_matches(['\r', '\n']);
        for (index, cell) in row.split(';').enumerate() {
            if index > 0 {
                out.push(',');
            }
            match (cell.contains(','), decimal_point(cell)) {
                (false, _) => out.push_str(cell),
                (true, Some(number)) => out.push_str(&number),
                (true, None) => {
                    out.push('"');
                    out.push_str(cell);
                    out.push('"');
                }
            }
        }
        out.push_str(&line[row.len()..]);
    }
    Cow::Owned(out)
}

/// A file of a finite-element program, or a table (CSV), with decimal points.
pub(crate) fn text_or_table(path: &Path) -> Answer<Text> {
    let text = Text::read(path)?;
    let is_table = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    Ok(match with_decimal_points(text.body()) {
        Cow::Owned(points) if is_table => Text::new(text.name(), points)?,
        _ => text,
    })
}

/// A number with a decimal comma, or several of them in one cell; `None` of anything else.
fn decimal_point(cell: &str) -> Option<String> {
    let is_number = |word: &str| {
        let commas = word.bytes().filter(|byte| *byte == b',').count();
        commas <= 1 && !word.contains('.') && word.replace(',', ".").parse::<f64>().is_ok()
    };
    let mut words = cell.split_whitespace();
    words.all(is_number).then(|| cell.replace(',', "."))
}

#[cfg(test)]
mod tests {
    use super::with_decimal_points as read;

    #[test]
    fn decimal_commas_are_read_where_semicolons_stand_between_cells() {
        let german = "# Messung; Halle 3\r\nx_mm;y_mm;name;a_b_c_kuka_deg\r\n-0,5;1,25e-3;links, oben;0 90,5 0\r\n";
        let points = "# Messung; Halle 3\r\nx_mm,y_mm,name,a_b_c_kuka_deg\r\n-0.5,1.25e-3,\"links, oben\",0 90.5 0\r\n";
        assert_eq!(read(german), points);
        for text in ["x_mm,y_mm\n1,2\n", "x_mm\n1,5\n", ""] {
            assert_eq!(read(text), text);
        }
        // A thousand with a point, and two commas, are no numbers.
        assert_eq!(read("a;b\n1.234,5;1,2,3\n"), "a,b\n\"1.234,5\",\"1,2,3\"\n");
    }
}
