//! Was über einen Lauf zu sagen ist.

use kinetostat_machining::{AssumptionKind, CornerLoad, LoadBegins, WeightCorrection};

use crate::number;
use crate::paper::language::Language;
use crate::paper::words::german::WORDS;
use crate::paper::words::shared::{corners, length, missed_place, uncertain};
use crate::run::meaning::{
    Statement, after_and_allowed, assumed, missed_features, worst_and_allowed,
};
use crate::run::shown::Shown;

/// Eine Zahl, wie sie im Deutschen steht.
pub(super) fn zahl(text: &str) -> String {
    Language::German.figure(text, &WORDS.figures)
}

/// Ein Satz oder mehrere.
pub(crate) fn statement(statement: &Statement, result: &Shown<'_>) -> Option<String> {
    let summary = &result.summary;
    let before = zahl(&result.figures.error_before);
    let (after, allowed) = after_and_allowed(result);
    let (after, allowed) = (zahl(&after), zahl(&allowed));
    let up_to = |mm: f64| zahl(&length(mm));
    Some(match statement {
        Statement::SpindleNotStarted => "DIE SPINDEL WIRD von diesem Programm NICHT GESTARTET.".to_owned(),
        Statement::NoPoint => "Es wurde kein Punkt des Programms gerechnet; es gibt nichts zu beurteilen.".to_owned(),
        Statement::Unstable { line } => {
            let place = line.map_or_else(String::new, |line| format!(", zuerst in Zeile {}", number::count(line)));
            format!("Die Maschine gibt unter dieser Last nach{place}: sie ist dort nicht stabil. Führen Sie dieses Programm mit dieser Last nicht aus; die Zahlen gelten nur, wo die Maschine stabil ist.")
        }
        Statement::NotConverged => "Für mindestens eine Stelle der Bahn fand die Rechnung keine Lösung. Verlassen Sie sich weder auf die Zahlen noch auf ein geschriebenes Programm, bevor der Grund gefunden ist (siehe Warnungen).".to_owned(),
        Statement::Unknown => "Der Fehler des Werkzeugs ist nicht bekannt, das Programm lässt sich nicht beurteilen: führen Sie es nicht aus, bevor der Grund gefunden ist (siehe Warnungen).".to_owned(),
        Statement::NoLoad => "In diesem Lauf wirkt keine Schnittkraft auf das Werkzeug.".to_owned(),
        Statement::Analysed => format!("Das Werkzeug liegt bis zu {before} neben seiner programmierten Bahn. Dies ist nur eine Analyse: es wurde kein kompensiertes Programm geschrieben."),
        Statement::Unchanged if summary.within_tolerance_before => format!("Nichts wurde korrigiert: so wie das Programm ist, liegt das Werkzeug höchstens {before} ab, innerhalb der Toleranz; es kommt Byte für Byte zurück."),
        Statement::Unchanged => format!("Es gab nichts zu korrigieren: keine Korrektur erreicht die letzte geschriebene Stelle; das Programm kommt Byte für Byte zurück. Das Werkzeug liegt höchstens {} ab.", zahl(&result.figures.error_after)),
        Statement::Missed { better } => {
            let first = match missed_place(result) {
                Some(place) => format!("Die Toleranz ist verfehlt, am meisten in Zeile {place}."),
                None => "Die Toleranz ist verfehlt.".to_owned(),
            };
            match better {
                true => format!("{first} Ohne Kompensation liegt das Werkzeug bis zu {before} ab, mit dem kompensierten Programm noch bis zu {after}, mehr als die verlangten {allowed}."),
                false => format!("{first} Das kompensierte Programm ist nicht besser als das Original: das Werkzeug liegt ohne Kompensation bis zu {before} ab, mit ihr bis zu {after}, mehr als die verlangten {allowed}."),
            }
        }
        Statement::WithinBefore => format!("Schon ohne Kompensation liegt das Werkzeug höchstens {before} ab, innerhalb der verlangten {allowed}; mit dem kompensierten Programm höchstens {after}."),
        Statement::Corrected => format!("Ohne Kompensation liegt das Werkzeug bis zu {before} ab, mit dem kompensierten Programm höchstens {after}."),
        Statement::FeaturesMissed => format!("Die Toleranz ist verfehlt bei: {}.", missed_features(result).join(", ")),
        Statement::AtWorst => match worst_and_allowed(result) {
            (Some(worst), allowed) => format!("Die Toleranz ist nur eingehalten, wenn die folgenden Annahmen zutreffen: sonst liegt das Werkzeug mit dem geschriebenen Programm bis zu {worst} ab, mehr als die verlangten {allowed}.", worst = zahl(&worst), allowed = zahl(&allowed)),
            (None, allowed) => format!("Die Toleranz von {allowed} ist nur eingehalten, wenn die folgenden Annahmen zutreffen; ohne die erste begrenzt nichts den Fehler.", allowed = zahl(&allowed)),
        },
        Statement::Assumed(AssumptionKind::BackwardSteps) => {
            let steps = summary.backward_steps;
            let [limit, longest] = [zahl(&number::length_setting(summary.backward_step_limit_mm)), up_to(summary.largest_backward_step_mm)];
            format!("Gegen die Bewegungsrichtung hat das Programm {} {}, länger als {limit}, bis {longest} lang: dabei wird nur dann nichts geschnitten, wenn die Maschine nachgibt wie gerechnet.", number::count(steps), if steps == 1 { "Schritt" } else { "Schritte" })
        }
        Statement::Assumed(AssumptionKind::OwnWeight) => {
            let whole = up_to(summary.max_displacement_by_weight_mm?);
            let error = up_to(summary.max_error_by_own_weight_mm?);
            let becomes = match result.run_inputs.compensated && !summary.unchanged {
                true => "wird korrigiert",
                false => "zählt als Fehler",
            };
            let part = match &result.run_inputs.weight {
                WeightCorrection::None => format!("nichts davon {becomes} (die Steuerung korrigiert das Gewicht)"),
                WeightCorrection::TouchOff(_) => format!("nur die Änderung von bis zu {error} gegenüber dem Ort, an dem das Werkstück angetastet wurde, {becomes}"),
                WeightCorrection::All | WeightCorrection::NotStated => format!("alles davon {becomes} (das Werkstück wurde ohne diese Maschine vermessen)"),
            };
            format!("Das Eigengewicht der Maschine und was sonst in ihrem Modell wirkt (Federn, Gegengewichte) verschieben das Werkzeug für sich allein um bis zu {whole}; {part}.")
        }
        Statement::Assumed(AssumptionKind::Corners) => {
            let c = corners(result)?;
            let places = match (c.corner, c.entry) {
                (Some(_), None) => "An scharfen Ecken",
                (None, _) => "Wo ein Eilgang endet",
                (Some(_), Some(_)) => "An scharfen Ecken und wo ein Eilgang endet",
            };
            let off = |mm: Option<f64>| match mm {
                Some(mm) => format!("liegt das Werkzeug dort bis zu {} ab", up_to(mm)),
                None => "gibt es dort kein Gleichgewicht".to_owned(),
            };
            let assumed = match c.reading {
                Some(CornerLoad::Turns) => format!("ist angenommen, dass sich die Last gleichmäßig dreht oder aufbaut, während das Werkzeug den Schritt macht; folgt sie stattdessen sofort dem Vorschub, {}", off(c.if_follows)),
                Some(CornerLoad::FollowsFeed) => format!("ist angenommen, dass die Last sofort dem Vorschub folgt; dreht sie sich gleichmäßig während des Schritts, {}", off(c.if_turns)),
                None => format!("ist die Last je nach Werkzeug verschieden gelesen; dreht sie sich bei allen gleichmäßig, {}; folgt sie bei allen dem Vorschub, {}", off(c.if_turns), off(c.if_follows)),
            };
            let counted = |what: &str, step: Option<(usize, f64)>| step.map(|(count, mm)| format!("{} {} {what}, bis {} lang", number::count(count), if count == 1 { "Schritt" } else { "Schritte" }, up_to(mm)));
            let steps: Vec<String> = [counted("an Ecken", c.corner), counted("am Ende von Eilgängen", c.entry)].into_iter().flatten().collect();
            format!("{places} {assumed}. Das betrifft {}, {} der Punkte.", steps.join(" und "), zahl(&c.percent))
        }
        Statement::Assumed(AssumptionKind::LoadRamp) => {
            let ramp = summary.load_ramp?;
            let length = up_to(ramp.length_mm);
            match ramp.begins {
                LoadBegins::AfterRapid => format!("Es ist nicht angegeben, wo ein Schnitt nach einem Eilgang beginnt: angenommen ist, dass die Last dort über höchstens die ersten {length} Vorschub kommt und bis zum nächsten Eilgang wirkt."),
                LoadBegins::BelowHeight => format!("Die Last kommt über die {length} Bahn, bevor das Werkzeug unter die Höhe geht, in der sie wirkt, und geht über ebenso viel dahinter; wo ein Eilgang näher endet, über die ersten {length} Vorschub."),
                _ => return None,
            }
        }
        Statement::Assumed(AssumptionKind::ForceSpread) => {
            let band = result.force_band.as_ref()?;
            let percent = zahl(&number::significant(band.spread_percent, 2, number::Rounding::Nearest));
            let line = number::count(band.line);
            let first = format!("Ist die Schnittkraft um {percent}\u{202f}% größer oder kleiner, wie es ihre Koeffizienten zulassen,");
            let solved = match band.points < band.of_points {
                true => format!(", gerechnet an {} Punkten, darunter denen mit den größten Fehlern und Kräften", number::count(band.points)),
                false => String::new(),
            };
            match band.max_error_mm() {
                Some(mm) => format!("{first} so liegt das Werkzeug bis zu {} ab (Zeile {line}{solved}).", up_to(mm)),
                None => format!("{first} so hat die Maschine in Zeile {line} kein Gleichgewicht."),
            }
        }
        Statement::Assumed(AssumptionKind::UncertainNumbers) => {
            let u = uncertain(result)?;
            let mut text = format!("Mit den {} unsicheren Zahlen aus {} ({} Maschinen gezogen, an {} Stellen gerechnet) liegt das Werkzeug wie programmiert bis zu {} ab", u.numbers, u.file, u.machines, u.places, zahl(&u.before));
            if let Some(after) = &u.after {
                text.push_str(&format!(", mit dem kompensierten Programm bis zu {}", zahl(after)));
            }
            text.push_str(&format!(" (Mittel und Standardabweichung; neunzehn von zwanzig Maschinen bleiben unter {}).", zahl(&u.high)));
            if !u.linear {
                text.push_str(" Diese Fehler sind in den Zahlen nicht linear: lineare Fortpflanzung reicht nicht.");
            }
            if u.unanswered > 0 {
                text.push_str(&format!(" {} dieser Maschinen haben irgendwo keine Lösung und sind in diesen Zahlen nicht enthalten.", u.unanswered));
            }
            if u.unstable > 0 {
                text.push_str(&format!(" {} DIESER MASCHINEN SIND irgendwo auf dem Programm NICHT STABIL.", u.unstable));
            }
            text
        }
        // Chatter has its own section in this language.
        Statement::Assumed(AssumptionKind::Chatter) => return None,
        // A kind without words in this language is quoted in English.
        Statement::Assumed(kind) => assumed(result, *kind),
        Statement::Tilt => {
            let angle = zahl(&result.figures.rotation);
            let inputs = &result.run_inputs;
            match (inputs.compensated, inputs.orientation_corrected, inputs.states_orientation) {
                (false, ..) => format!("Es verkippt um bis zu {angle}."),
                (true, true, _) => format!("Das Werkzeug bleibt um bis zu {angle} verkippt."),
                (true, false, true) => format!("Das Werkzeug bleibt um bis zu {angle} verkippt, was --correct pose mit korrigiert."),
                (true, false, false) => format!("Das Werkzeug bleibt um bis zu {angle} verkippt, was ein Programm aus Positionen nicht korrigieren kann."),
            }
        }
    })
}
