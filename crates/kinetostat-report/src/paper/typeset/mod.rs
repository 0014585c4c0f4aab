//! A paper set on pages of A4 and written as PDF.

mod layout;
mod letters;
mod pictures;
mod tables;

use krilla::Document;
use krilla::SerializeSettings;
use krilla::color::rgb;
use krilla::configure::{Configuration, Validator};
use krilla::geom::{PathBuilder, Point, Rect};
use krilla::metadata::{DateTime, Metadata};
use krilla::page::PageSettings;
use krilla::paint::Fill;
use krilla::surface::Surface;

use crate::ReportError;
use crate::paper::block::Contents;
use crate::paper::typeset::layout::{BOTTOM, HEIGHT, LEFT, Mark, RIGHT, Setter, TOP, WIDTH};
use crate::paper::typeset::letters::{Letters, Weight};
use crate::paper::words::table::fill;

/// Size of what stands on every page, points.
const RUNNING: f32 = 7.5;

fn fault(what: impl std::fmt::Display) -> ReportError {
    ReportError::Pdf(what.to_string())
}

/// The document's bytes.
pub(crate) fn pdf(contents: &Contents) -> Result<Vec<u8>, ReportError> {
    let letters = Letters::new().ok_or_else(|| fault("its letters cannot be read"))?;
    let pages = Setter::pages(&letters, contents);
    let date = contents.date.as_deref().and_then(day);
    // An archive wants a date; a run without one has none to give.
    let validator = match date {
        Some(_) => Validator::A2_B,
        None => Validator::None,
    };
    let mut document = Document::new_with(SerializeSettings {
        configuration: Configuration::new_with_validator(validator),
        enable_tagging: false,
        ..SerializeSettings::default()
    });
    let count = pages.len();
    for (index, marks) in pages.iter().enumerate() {
        let settings =
            PageSettings::from_wh(WIDTH, HEIGHT).ok_or_else(|| fault("its page has no size"))?;
        let mut page = document.start_page_with(settings);
        let mut surface = page.surface();
        for mark in marks {
            draw(&mut surface, &letters, mark);
        }
        for mark in running(&letters, contents, index + 1, count) {
            draw(&mut surface, &letters, &mark);
        }
        surface.finish();
        page.finish();
    }
    let mut metadata = Metadata::new()
        .title(letters.writable(&contents.title))
        .language(contents.language.code().to_owned())
        .creator(contents.running[1].clone());
    if let Some(date) = date {
        metadata = metadata.creation_date(date);
    }
    document.set_metadata(metadata);
    document
        .finish()
        .map_err(|error| fault(format!("{error:?}")))
}

/// Place and size of every drawing: left, top, width, height.
#[cfg(test)]
pub(crate) fn pictures_of(contents: &Contents) -> Vec<[f32; 4]> {
    let letters = Letters::new().expect("the letters can be read");
    let pages = Setter::pages(&letters, contents);
    let place = |mark: &Mark| match mark {
        Mark::Picture { at, size, .. } => Some([at[0], at[1], size[0], size[1]]),
        _ => None,
    };
    pages.iter().flatten().filter_map(place).collect()
}

/// `2026-11-20`.
fn day(text: &str) -> Option<DateTime> {
    let mut parts = text.splitn(3, '-');
    let year = parts.next()?.parse().ok()?;
    let month: u8 = parts.next()?.parse().ok()?;
    let day: u8 = parts.next()?.parse().ok()?;
    let whole = (1..=12).contains(&month) && (1..=31).contains(&day);
    whole.then(|| DateTime::new(year).month(month).day(day))
}

/// Head and foot of every page: the program, who made the paper, and the number of the page.
fn running(letters: &Letters, contents: &Contents, page: usize, pages: usize) -> Vec<Mark> {
    let [program, made_by] = &contents.running;
    let [page, pages] = [page, pages].map(|number| number.to_string());
    let number = fill(
        contents.page_of,
        &[("page", page.as_str()), ("pages", &pages)],
    );
    let text = |x, y, text: &str, weight| Mark::Text {
        x,
        y,
        text: letters.writable(text),
        weight,
        size: RUNNING,
        grey: 90,
    };
    let right = |text: &str| RIGHT - letters.width(text, Weight::Regular, RUNNING);
    let foot = HEIGHT - BOTTOM + 22.0;
    let program = letters.writable(program);
    // Long names stay beside what stands to the right.
    let lines = letters.lines(&program, Weight::Bold, RUNNING, 330.0);
    let shown = lines.first().map_or("", String::as_str);
    let date = contents.date.as_deref().unwrap_or_default();
    vec![
        text(LEFT, TOP - 22.0, shown, Weight::Bold),
        text(right(date), TOP - 22.0, date, Weight::Regular),
        Mark::rule(LEFT, TOP - 16.0, RIGHT),
        Mark::rule(LEFT, foot - 12.0, RIGHT),
        text(LEFT, foot, made_by, Weight::Regular),
        text(right(&number), foot, &number, Weight::Regular),
    ]
}

fn draw(surface: &mut Surface<'_>, letters: &Letters, mark: &Mark) {
    let shade = |grey: u8| Fill {
        paint: rgb::Color::new(grey, grey, grey).into(),
        ..Fill::default()
    };
    match mark {
        Mark::Text {
            x,
            y,
            text,
            weight,
            size,
            grey,
        } => {
            surface.set_fill(Some(shade(*grey)));
            let glyphs = letters.glyphs(text, *weight);
            let start = Point::from_xy(*x, *y);
            surface.draw_glyphs(start, &glyphs, letters.font(*weight), text, *size, false);
        }
        Mark::Picture { at, size, picture } => picture.draw(surface, *at, *size),
        Mark::Area {
            x,
            y,
            width,
            height,
            colour,
        } => {
            let [r, g, b] = *colour;
            surface.set_fill(Some(Fill {
                paint: rgb::Color::new(r, g, b).into(),
                ..Fill::default()
            }));
            let mut path = PathBuilder::new();
            if let Some(area) = Rect::from_xywh(*x, *y, *width, *height) {
                path.push_rect(area);
            }
            if let Some(path) = path.finish() {
                surface.draw_path(&path);
            }
        }
    }
}
