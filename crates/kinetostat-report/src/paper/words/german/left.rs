//! Was ein Programm übrig lässt.

use kinetostat_machining::AssumptionKind;

use crate::number;
use crate::paper::words::german::sentences::{statement, zahl};
use crate::paper::words::shared::{stated_change, uncertain_numbers};
use crate::run::facts::Left;
use crate::run::meaning::Statement;
use crate::run::shown::Shown;

/// Name, Größe und Erklärung.
pub(crate) fn left(left: Left, result: &Shown<'_>) -> [String; 3] {
    let summary = &result.summary;
    let figure = zahl(&left.figure(result));
    let size = match left.counted(result) {
        Some(0) => "keine".to_owned(),
        Some(count) if left == Left::FeedLimited => format!("{} Stücke", number::count(count)),
        Some(count) => format!("{}, längster {figure}", number::count(count)),
        None => figure.clone(),
    };
    let said = |s| statement(&s, result).unwrap_or_default();
    let (name, text) = match left {
        Left::Tilt => ("Verkippung des Werkzeugs", "Last, Gewicht und Montagefehler verschieben das Werkzeug nicht nur, sie drehen es auch. Ein Programm aus Positionen bringt die Werkzeugspitze an ihren Ort zurück, kann sie aber nicht zurückdrehen; eine tief unter der Spitze gefräste Seitenwand zeigt es.".to_owned()),
        Left::ForceOfCut => ("Schnittkraft", said(Statement::Assumed(AssumptionKind::ForceSpread))),
        Left::Uncertain => ("Maschine und Kraft, wie sie sein können", {
            let (numbers, seed, linear, deviation) = uncertain_numbers(result);
            let linear = match linear { true => "Lineare Fortpflanzung stimmt damit überein", false => "Lineare Fortpflanzung reicht nicht: die Fehler sind in diesen Zahlen nicht linear" };
            format!("Maschinen gezogen mit {numbers}, Startwert {seed}. Mittel und Standardabweichung des größten Fehlers. {linear} (vor der Kompensation: Abweichung {}).", zahl(&deviation))
        }),
        Left::Rounding => ("Runden", {
            let (lengths, angles) = summary.decimals.shown(result.run_inputs.decimals, "bis");
            let angles = angles.map_or_else(String::new, |angles| format!(", Winkel mit {angles}"));
            format!("Längen werden mit {lengths} Nachkommastellen geschrieben{angles}. Dieser Teil des Fehlers nach der Kompensation kommt allein davon.")
        }),
        Left::CornerSteps => ("Schritte an Ecken", format!("Wo sich die Last sofort dreht, wie an einer scharfen Ecke, dreht sich die Korrektur mit: das Programm macht dort einen kurzen Schritt, während das Werkzeug an seiner Ecke steht. {}", said(Statement::Assumed(AssumptionKind::Corners))).trim_end().to_owned()),
        Left::EntrySteps => ("Schritte am Ende von Eilgängen", "Die Last ist am Ende eines Eilgangs sofort da: das Programm macht einen Schritt, während das Werkzeug an seinem Ort steht.".to_owned()),
        Left::Change => ("Änderung der Korrektur", {
            let (line, stated) = stated_change(result);
            let beside = match stated {
                None => String::new(),
                Some((stated, 0)) => format!("; keine Zeile ändert schneller als die angegebenen {} (largest_step_mm_per_mm)", zahl(&stated)),
                Some((stated, lines)) => format!(". Zeilen mit schnellerer Änderung als angegeben: {lines} ({} an dieser, largest_step_mm_per_mm); siehe Warnungen", zahl(&stated)),
            };
            format!("Die schnellste je mm Bahn außerhalb von Schritten, aus den geschriebenen Positionen, in Zeile {line}{beside}.")
        }),
        Left::Backwards => ("Weg rückwärts", format!("Der längste Schritt gegen die Bewegungsrichtung; länger als {} sind {}.", zahl(&number::length_setting(summary.backward_step_limit_mm)), number::count(summary.backward_steps))),
        Left::FeedLimited => ("Begrenzter Vorschub", format!("Ihr Vorschub ist auf das {}-fache des programmierten begrenzt, das Werkstück wird dort also langsamer geschnitten als programmiert, am langsamsten mit {figure} der Geschwindigkeit, zuerst in Zeile {}.", zahl(&number::setting(summary.max_feed_factor)), number::count(summary.feed_limited_line.unwrap_or(0)))),
    };
    [name.to_owned(), size, text]
}
