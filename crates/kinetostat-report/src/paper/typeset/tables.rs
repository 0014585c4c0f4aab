//! Tables on pages: widths of columns, heads again on every page.

use crate::paper::block::{Cell, Side, Table};
use crate::paper::typeset::layout::{LEFT, Mark, RIGHT, Setter};
use crate::paper::typeset::letters::Weight;

/// Size of text in tables, and how far its lines are apart.
const SIZE: f32 = 8.0;
/// Smallest size, in tables with hashes and in wide ones.
const SMALLEST: f32 = 6.0;
const LEADING: f32 = 1.3;
/// Gap between columns.
const GAP: f32 = 10.0;
/// The narrowest column whose text wraps.
const NARROWEST: f32 = 56.0;

fn weight(cell: &Cell) -> Weight {
    match cell.strong {
        true => Weight::Bold,
        false => Weight::Regular,
    }
}

impl Setter<'_> {
    /// A table, in the largest type in which its columns stand side by side.
    pub(super) fn table(&mut self, table: &Table) {
        let mut size = SIZE;
        let mut widths = self.widths(table, size);
        while size > SMALLEST && !self.fits(table, &widths, size) {
            size -= 0.5;
            widths = self.widths(table, size);
        }
        let heads: Vec<Cell> = table
            .columns
            .iter()
            .map(|column| Cell::strong(column.head.clone()))
            .collect();
        // A head is not alone at the foot of a page.
        let first = table.rows.first().map_or(&heads, |row| row);
        // Each row ends with a line.
        self.room(self.height(&heads, &widths, size) + self.height(first, &widths, size) + 4.0);
        self.row(table, &heads, &widths, size, true);
        for row in &table.rows {
            let height = self.height(row, &widths, size);
            let before = self.y;
            self.room(height);
            if self.y < before {
                self.row(table, &heads, &widths, size, true);
            }
            self.row(table, row, &widths, size, false);
        }
        self.y += 4.0;
    }

    /// True if all columns fit side by side and no word, nor the name of a file, is broken.
    fn fits(&self, table: &Table, widths: &[f32], size: f32) -> bool {
        let gaps = GAP * widths.len().saturating_sub(1) as f32;
        let whole = |row: &Vec<Cell>| {
            row.iter().zip(widths).all(|(cell, width)| {
                let mut words = cell.text.split(' ');
                words.all(|word| self.wide(word, weight(cell), size) <= *width + 0.1)
            })
        };
        widths.iter().sum::<f32>() + gaps <= RIGHT - LEFT + 0.5 && table.rows.iter().all(whole)
    }

    /// Columns that do not wrap are as wide as what stands in them; the others share what is left, by what they want.
    fn widths(&self, table: &Table, size: f32) -> Vec<f32> {
        let wanted: Vec<f32> = table
            .columns
            .iter()
            .enumerate()
            .map(|(at, column)| {
                let cells = table.rows.iter().filter_map(|row| row.get(at));
                let cells = cells.map(|cell| self.wide(&cell.text, weight(cell), size));
                // Heads may wrap between words.
                let words = column.head.split(' ');
                let head = words.map(|word| self.wide(word, Weight::Bold, size));
                cells.chain(head).fold(0.0, f32::max)
            })
            .collect();
        let wraps = |at: usize| table.columns[at].wraps;
        let gaps = GAP * (wanted.len().saturating_sub(1)) as f32;
        let fixed: f32 = (0..wanted.len())
            .filter(|at| !wraps(*at))
            .map(|at| wanted[at])
            .sum();
        let free = RIGHT - LEFT - gaps - fixed;
        let wish: f32 = (0..wanted.len())
            .filter(|at| wraps(*at))
            .map(|at| wanted[at])
            .sum();
        let count = (0..wanted.len()).filter(|at| wraps(*at)).count() as f32;
        (0..wanted.len())
            .map(|at| match wraps(at) {
                false => wanted[at],
                // Columns of words get the remaining width, so that figures stand to the right.
                true if wish <= free => wanted[at] + (free - wish) / count,
                true => (free * wanted[at] / wish).max(NARROWEST),
            })
            .collect()
    }

    fn wide(&self, text: &str, weight: Weight, size: f32) -> f32 {
        let text = self.letters.writable(text);
        self.letters.width(&text, weight, size)
    }

    fn height(&self, row: &[Cell], widths: &[f32], size: f32) -> f32 {
        let lines = row.iter().zip(widths).map(|(cell, width)| {
            let lines = self.lines(&cell.text, *width + 0.1, size, weight(cell));
            lines.len()
        });
        lines.max().unwrap_or(1) as f32 * size * LEADING + 3.0
    }

    fn row(&mut self, table: &Table, row: &[Cell], widths: &[f32], size: f32, head: bool) {
        let height = self.height(row, widths, size);
        self.room(height);
        let top = self.y;
        let mut x = LEFT;
        for ((cell, width), column) in row.iter().zip(widths).zip(&table.columns) {
            let weight = weight(cell);
            let lines = self.lines(&cell.text, *width + 0.1, size, weight);
            for (index, line) in lines.into_iter().enumerate() {
                let own = self.letters.width(&line, weight, size);
                let at = match column.side {
                    Side::Left => x,
                    Side::Right => x + width - own,
                };
                let y = top + index as f32 * size * LEADING;
                self.line_at(at, y + 1.0, line, size, weight);
            }
            x += width + GAP;
        }
        self.y = top + height;
        let shade = if head { 90 } else { 215 };
        let mark = match Mark::rule(LEFT, self.y - 0.5, RIGHT) {
            Mark::Area {
                x,
                y,
                width,
                height,
                ..
            } => Mark::Area {
                x,
                y,
                width,
                height,
                colour: [shade; 3],
            },
            text => text,
        };
        self.put(mark);
        self.y += 1.0;
    }
}
