//! Deutsch.

use kinetostat_machining::{AssumptionKind, CornerLoad, LoadBegins, WeightCorrection};

use crate::number;
use crate::paper::language::{FigureWords, Language};
use crate::paper::words::shared::{
    corners, length, missed_place, stated_change, uncertain, uncertain_numbers,
};
use crate::paper::words::table::Words;
use crate::run::Shown;
use crate::run::facts::Left;
use crate::run::meaning::{
    Statement, after_and_allowed, assumed, missed_features, worst_and_allowed,
};

pub(super) const WORDS: Words = Words {
    figures: FigureWords {
        missing: "nicht bekannt",
        below: "unter",
    },
    kind_compensated: "Bericht über ein kompensiertes Bearbeitungsprogramm",
    kind_analysed: "Bericht über ein Bearbeitungsprogramm, nur Analyse",
    kind_verified: "Bericht über ein nachgerechnetes Bearbeitungsprogramm",
    title: "{program} auf {machine}",
    page_of: "Seite {page} von {pages}",
    made_by: "kinetostat {version}",
    quoted: "Zahlen haben ein Dezimalkomma. Angaben aus Modell und Auftrag sowie Warnungen stehen im englischen Wortlaut der Rechnung, mit Dezimalpunkt.",
    not_stated: "nicht angegeben",
    none: "keine",
    yes_no: ["ja", "nein"],
    good: "Korrigiert",
    unchanged: "Unverändert",
    analysis: "Analyse",
    attention: "Achtung",
    stop: "Nicht ausführen",
    verified: "Bestätigt",
    missed: "Toleranz verfehlt",
    not_verified: "Nicht bestätigt",
    model_only: "Diese Zahlen sind die des Modells: sie stimmen so weit, wie dessen Steifigkeiten und Massen stimmen. Messen Sie eine Stelle an der Maschine nach, bevor Sie sich auf Beträge verlassen.",
    read_back: "Die Zahlen nach der Kompensation sind keine Vorhersage des Korrekturverfahrens: die geschriebene Datei wurde wieder eingelesen und neu durchgerechnet.",
    head_results: "Vorher und nachher",
    head_features: "Die einzelnen Formelemente",
    head_worst: "Die ungünstigsten Zeilen",
    head_drives: "Belastung der Antriebe",
    head_cut: "Schnittkräfte",
    head_left: "Was nicht korrigiert ist und was die Zahlen nicht enthalten",
    head_warnings: "Warnungen",
    head_inputs: "Modell, Werkzeug, Last und Toleranzen",
    head_files: "Dateien und ihre SHA-256-Prüfsummen",
    head_signatures: "Unterschriften",
    date: "Datum",
    program: "Programm",
    original: "Original",
    part_number: "Teilenummer",
    revision: "Revision",
    machine: "Maschinenmodell",
    model_from: "Modell aus",
    deviations: "Abweichungen von der Zeichnung",
    stiffnesses: "Verwendete Steifigkeiten",
    load: "Last",
    material: "Werkstoff und Schnittkraft",
    no_material: "nicht aus dem Schnitt berechnet: die Last ist vorgegeben",
    placement: "Lage des Programms",
    tool: "Werkzeug",
    orientation: "Orientierung des Werkzeugs",
    path: "Länge im Vorschub",
    flat: "Aufgelöst mit",
    blocks_read: "Gelesene Sätze",
    blocks_written: "Geschriebene Sätze",
    bytes: "{blocks} ({bytes} Byte)",
    tolerance_path: "Toleranz der Bahn",
    tolerance_chords: "Toleranz der Sehnen in Bögen",
    decimals: "Geschriebene Nachkommastellen, mindestens",
    figure: "Größe",
    before: "vorher",
    after: "nachher",
    of_original: "Original",
    of_verified: "dieses Programm",
    largest_error: "größter Positionsfehler des Werkzeugs",
    rms_error: "quadratisches Mittel davon",
    allowed_in_all: "insgesamt zulässiger Fehler",
    held: "Toleranz des ganzen Programms eingehalten",
    rounding: "davon durch Runden",
    largest_correction: "größte Korrektur",
    tilt: "Verkippung des Werkzeugs",
    stiffness: "kleinste Steifigkeit gegen eine Kraft",
    buckling: "Anteil der Knicklast (100 % ist Knicken)",
    no_buckling: "kein Glied dieses Modells kann knicken",
    speed: "Fehler der Bahngeschwindigkeit",
    blocks_per_second: "höchste Satzfolge je Sekunde",
    points: "gerechnete Punkte",
    stable: "stabil auf dem ganzen Programm",
    feature: "Formelement",
    lines: "Zeilen",
    lines_to: "{first} bis {last}",
    allowed: "zulässig",
    verdict: "Urteil",
    kept: "eingehalten",
    missed_here: "VERFEHLT",
    nothing_cut: "ohne Schnitt",
    picture_along: "Abstand des Werkzeugs von seinem programmierten Ort entlang der Bahn",
    picture_above: "Die Bahn von oben",
    picture_machine: "Die Maschine in Zeile {line}, wo das Werkzeug ohne Kompensation am weitesten abläge",
    along_path: "Länge der Bahn",
    distance: "Abstand",
    programmed: "programmierte Bahn",
    displaced: "Werkzeug ohne Kompensation, Abweichung × {factor}",
    worst_note: "Wo das Werkzeug ohne Kompensation am weitesten abliegt, die ungünstigste Zeile zuerst; Orte in Programmkoordinaten.",
    worst_note_verified: "Wo das Werkzeug mit diesem Programm am weitesten abliegt, die ungünstigste Zeile zuerst; Orte in Programmkoordinaten.",
    worst_after_note: "Wo es mit dem kompensierten Programm am weitesten abliegt, die ungünstigste Zeile zuerst.",
    line: "Zeile",
    line_written: "Zeile geschrieben",
    line_from: "aus {line} von {file}",
    drive: "Antrieb",
    largest_force: "größte Last",
    rating: "Nennwert",
    share: "Anteil",
    correction: "größte Korrektur",
    range: "Weg von … bis",
    limits: "Grenzen",
    no_ratings: "Das Modell nennt keine Nennwerte der Antriebe; die Lasten sind mit keinem verglichen.",
    nearest_limit: "Nächste Achsgrenze",
    nearest_limit_text: "Kleinster Abstand eines Gelenks von einer seiner Grenzen: {drive}, {end} Grenze, Zeile {line}.",
    lower: "untere",
    upper: "obere",
    most_loaded: "Last zu Nennwert",
    most_loaded_text: "Größte Kraft oder größtes Moment eines Antriebs als Anteil des Nennwerts im Modell: {drive}, Zeile {line}.",
    configuration: "Konfiguration des Arms",
    configuration_changes: "sie wechselt {count}-mal",
    shoulder: ["vorn", "hinten"],
    elbow: ["Ellenbogen oben", "Ellenbogen unten"],
    wrist: ["Handgelenk nicht umgeschlagen", "Handgelenk umgeschlagen"],
    cut_force: "Kraft",
    cut_torque: "Moment",
    cut_share: "Anteil der Spindel",
    cut_power: "Leistung",
    cut_depth: "Tiefe",
    cut_spread: "Tabellierte Schnittkraftkoeffizienten treffen eine andere Charge oder ein anderes Werkzeug auf ±{percent} %.",
    cut_spindle: "Das Drehmoment der Spindel reicht nicht aus: siehe Warnungen.",
    head_chatter: "Rattern und Schwingungen",
    chatter_unjudged: "Keine Stelle ist beurteilt.",
    chatter_none: "Keine der beurteilten Stellen rattert.",
    chatter_without: "Stellen ohne Antwort: {count}.",
    chatter_some: "Diese Zeilen rattern:",
    chatter_columns: [
        "Drehzahl,\u{a0}1/min",
        "Tiefe,\u{a0}mm",
        "Stabil\u{a0}bis,\u{a0}mm",
        "Rattern,\u{a0}Hz",
        "Stabil\u{a0}bei,\u{a0}1/min",
    ],
    chatter_nearest: "Grenztiefe, der der Schnitt am nächsten kommt",
    chatter_nearest_text: "in Zeile {line}, wo das Programm {depth} tief schneidet",
    chatter_spread_text: "; die Kraft kann um {spread} größer sein als nach ihrem Gesetz, dann rattert der Schnitt ab {limit}",
    shaken: "Erzwungene Schwingung der Spitze (Effektivwert)",
    shaken_text: "in Zeile {line}, vor allem mit {frequency}, neben einer Eigenschwingung mit {mode}",
    wall: "Was sie an einer Wand hinterlässt",
    wall_text: "in Zeile {line}, {side}; keine Kompensation nimmt es weg",
    wall_sides: ["zu tief", "stehen geblieben"],
    chatter_note: "Dämpfung: {damping}. Die Grenzen sind für das Modell exakt, in der Stellung an jeder Stelle; Eigenschwingungen von Spindel, Werkzeug und Werkstück enthalten sie nur, wenn das Modell sie hat.",
    not_covered: "Die Rechnung ist statisch: ohne Schwingungen, ohne Rattern, ohne Wärmegang, ohne Reibung und Umkehrspiel. Die Schnittkräfte gelten für ein Werkzeug, das sich nicht biegt, und ein Werkstück, das nicht federt.",
    not_covered_beside_chatter: "Die Abweichungen sind statisch: ohne Wärmegang, ohne Reibung und Umkehrspiel, Schwingungen nur wie oben angegeben. Die Schnittkräfte gelten für ein Werkzeug, das sich nicht biegt, und ein Werkstück, das nicht federt.",
    more_warnings: "{count} weitere Warnungen stehen in der Ergebnisdatei.",
    more_features: "{count} weitere Formelemente stehen in der Ergebnisdatei.",
    file_what: "Was",
    file_name: "Datei",
    file_program: "Programm",
    file_model: "Modell",
    file_job: "Auftrag",
    file_material: "Werkstoff",
    file_written: "geschriebenes Programm",
    file_verified: "nachgerechnetes Programm",
    signed_by: ["Gerechnet", "Geprüft", "Freigegeben"],
    name_and_date: "Name, Datum",
    signature: "Unterschrift",
    uncut: [
        "Die Zeile {first} des Originals schneidet dieses Programm nicht: {length} Bahn.",
        "Die Zeilen {first} bis {last} des Originals schneidet dieses Programm nicht: {length} Bahn.",
    ],
    rapid_elsewhere: "Der Eilgang in Zeile {line} dieses Programms geht anderswo als der des Originals, um bis zu {length}.",
    extra_cut: "Zeile {line} dieses Programms ist eine Vorschubbewegung, die das Original nicht macht: {length} lang.",
    other_word: "In Zeile {line} hat dieses Programm einen anderen Vorschub, eine andere Drehzahl oder Drehrichtung, ein anderes Werkzeug oder einen anderen Nullpunkt als das Original.",
};

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
        Left::Rounding => ("Runden", format!("Zahlen werden mit mindestens {} Nachkommastellen geschrieben: solche, die mehr hatten, behalten sie. Dieser Teil des Fehlers nach der Kompensation kommt allein davon.", result.run_inputs.decimals)),
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
