//! Ce qu'il y a à dire d'un calcul.

use kinetostat_machining::{AssumptionKind, CornerLoad, LoadBegins, WeightCorrection};

use crate::number;
use crate::paper::language::Language;
use crate::paper::words::french::WORDS;
use crate::paper::words::shared::{corners, length, missed_place, uncertain};
use crate::run::meaning::{
    Statement, after_and_allowed, assumed, missed_features, worst_and_allowed,
};
use crate::run::shown::Shown;

/// Un nombre, comme on l'écrit en français.
pub(super) fn nombre(text: &str) -> String {
    Language::French.figure(text, &WORDS.figures)
}

/// Une phrase ou plusieurs.
pub(crate) fn statement(statement: &Statement, result: &Shown<'_>) -> Option<String> {
    let summary = &result.summary;
    let before = nombre(&result.figures.error_before);
    let (after, allowed) = after_and_allowed(result);
    let (after, allowed) = (nombre(&after), nombre(&allowed));
    let up_to = |mm: f64| nombre(&length(mm));
    Some(match statement {
        Statement::SpindleNotStarted => "LA BROCHE N’EST PAS MISE EN MARCHE par ce programme.".to_owned(),
        Statement::NoPoint => "Aucun point du programme n’a été calculé : il n’y a rien à juger.".to_owned(),
        Statement::Unstable { line } => {
            let place = line.map_or_else(String::new, |line| format!(", d’abord à la ligne {}", number::count(line)));
            format!("La machine cède sous cette charge{place} : elle n’y est pas stable. N’exécutez pas ce programme avec cette charge ; les valeurs ne valent que là où la machine est stable.")
        }
        Statement::NotConverged => "Pour au moins un endroit de la trajectoire, le calcul n’a pas trouvé de solution. Ne vous fiez ni aux valeurs ni à un programme écrit avant d’en avoir trouvé la cause (voir les avertissements).".to_owned(),
        Statement::Unknown => "L’écart de l’outil n’est pas connu, le programme ne peut pas être jugé : ne l’exécutez pas avant d’en avoir trouvé la cause (voir les avertissements).".to_owned(),
        Statement::NoLoad => "Aucun effort de coupe n’agit sur l’outil dans ce calcul.".to_owned(),
        Statement::Analysed => format!("L’outil s’écarte jusqu’à {before} de sa trajectoire programmée. Ceci est une analyse seule : aucun programme compensé n’a été écrit."),
        Statement::Unchanged if summary.within_tolerance_before => format!("Rien n’a été corrigé : tel que le programme est, l’outil s’écarte d’au plus {before}, dans la tolérance ; il revient octet pour octet."),
        Statement::Unchanged => format!("Il n’y avait rien à corriger : aucune correction n’atteint la dernière décimale écrite ; le programme revient octet pour octet. L’outil s’écarte d’au plus {}.", nombre(&result.figures.error_after)),
        Statement::Missed { better } => {
            let first = match missed_place(result) {
                Some(place) => format!("La tolérance n’est pas tenue, surtout à la ligne {place}."),
                None => "La tolérance n’est pas tenue.".to_owned(),
            };
            match better {
                true => format!("{first} Sans compensation, l’outil s’écarte jusqu’à {before} ; avec le programme compensé, encore jusqu’à {after}, plus que les {allowed} demandés."),
                false => format!("{first} Le programme compensé n’est pas meilleur que l’original : l’outil s’écarte jusqu’à {before} sans compensation et jusqu’à {after} avec elle, plus que les {allowed} demandés."),
            }
        }
        Statement::WithinBefore => format!("Même sans compensation, l’outil s’écarte d’au plus {before}, dans les {allowed} demandés ; avec le programme compensé, d’au plus {after}."),
        Statement::Corrected => format!("Sans compensation, l’outil s’écarte jusqu’à {before} ; avec le programme compensé, d’au plus {after}."),
        Statement::FeaturesMissed => format!("La tolérance n’est pas tenue pour : {}.", missed_features(result).join(", ")),
        Statement::AtWorst => match worst_and_allowed(result) {
            (Some(worst), allowed) => format!("La tolérance n’est tenue que si les hypothèses ci-dessous se vérifient : sinon l’outil s’écarte jusqu’à {worst} avec le programme écrit, plus que les {allowed} demandés.", worst = nombre(&worst), allowed = nombre(&allowed)),
            (None, allowed) => format!("La tolérance de {allowed} n’est tenue que si les hypothèses ci-dessous se vérifient ; sans la première, rien ne borne l’erreur.", allowed = nombre(&allowed)),
        },
        Statement::Assumed(AssumptionKind::BackwardSteps) => {
            let [limit, longest] = [nombre(&number::length_setting(summary.backward_step_limit_mm)), up_to(summary.largest_backward_step_mm)];
            format!("Contre le sens du mouvement, le programme a {} pas de plus de {limit}, jusqu’à {longest} : il n’y est rien coupé que si la machine cède comme calculé.", number::count(summary.backward_steps))
        }
        Statement::Assumed(AssumptionKind::OwnWeight) => {
            let whole = up_to(summary.max_displacement_by_weight_mm?);
            let error = up_to(summary.max_error_by_own_weight_mm?);
            let becomes = match result.run_inputs.compensated && !summary.unchanged {
                true => "est corrigé",
                false => "compte comme erreur",
            };
            let part = match &result.run_inputs.weight {
                WeightCorrection::None => format!("rien n’en {becomes} (la commande corrige le poids)"),
                WeightCorrection::TouchOff(_) => format!("seul le changement, jusqu’à {error} depuis l’endroit où la pièce a été palpée, {becomes}"),
                WeightCorrection::All | WeightCorrection::NotStated => format!("tout en {becomes} (la pièce a été mesurée sans cette machine)"),
            };
            format!("À eux seuls, le poids propre de la machine et ce qui agit encore dans son modèle (ressorts, contrepoids) déplacent l’outil jusqu’à {whole} ; {part}.")
        }
        Statement::Assumed(AssumptionKind::Corners) => {
            let c = corners(result)?;
            let places = match (c.corner, c.entry) {
                (Some(_), None) => "Aux angles vifs",
                (None, _) => "À la fin d’un déplacement rapide",
                (Some(_), Some(_)) => "Aux angles vifs et à la fin d’un déplacement rapide",
            };
            let off = |mm: Option<f64>| match mm {
                Some(mm) => format!("l’outil s’y écarte jusqu’à {}", up_to(mm)),
                None => "il n’y a pas d’équilibre".to_owned(),
            };
            let assumed = match c.reading {
                Some(CornerLoad::Turns) => format!("on suppose que la charge tourne ou s’établit régulièrement pendant le pas de l’outil ; si elle suit aussitôt l’avance, {}", off(c.if_follows)),
                Some(CornerLoad::FollowsFeed) => format!("on suppose que la charge suit aussitôt l’avance ; si elle tourne régulièrement pendant le pas, {}", off(c.if_turns)),
                None => format!("la charge est lue selon l’outil ; si elle tourne régulièrement avec tous, {} ; si elle suit l’avance avec tous, {}", off(c.if_turns), off(c.if_follows)),
            };
            let counted = |what: &str, step: Option<(usize, f64)>| step.map(|(count, mm)| format!("{} {what}, d’au plus {}", number::count(count), up_to(mm)));
            let steps: Vec<String> = [counted("pas aux angles", c.corner), counted("pas en fin de rapide", c.entry)].into_iter().flatten().collect();
            format!("{places}, {assumed}. Cela concerne {}, soit {} des points.", steps.join(" et "), nombre(&c.percent))
        }
        Statement::Assumed(AssumptionKind::LoadRamp) => {
            let ramp = summary.load_ramp?;
            let length = up_to(ramp.length_mm);
            match ramp.begins {
                LoadBegins::AfterRapid => format!("Il n’est pas indiqué où une coupe commence après un déplacement rapide : on suppose que la charge y vient sur au plus les premiers {length} d’avance et agit jusqu’au rapide suivant."),
                LoadBegins::BelowHeight => format!("La charge vient sur les {length} de trajectoire avant que l’outil ne passe sous la hauteur où elle agit, et s’en va sur autant derrière ; où un rapide finit plus près, sur les premiers {length} d’avance."),
                _ => return None,
            }
        }
        Statement::Assumed(AssumptionKind::ForceSpread) => {
            let band = result.force_band.as_ref()?;
            let percent = nombre(&number::significant(band.spread_percent, 2, number::Rounding::Nearest));
            let line = number::count(band.line);
            let first = format!("Si l’effort de coupe est de {percent}\u{202f}% plus grand ou plus petit, comme ses coefficients le permettent,");
            let solved = match band.points < band.of_points {
                true => format!(", calculé en {} points, dont ceux des plus grands écarts et efforts", number::count(band.points)),
                false => String::new(),
            };
            match band.max_error_mm() {
                Some(mm) => format!("{first} l’outil s’écarte jusqu’à {} (ligne {line}{solved}).", up_to(mm)),
                None => format!("{first} la machine n’a pas d’équilibre à la ligne {line}."),
            }
        }
        Statement::Assumed(AssumptionKind::UncertainNumbers) => {
            let u = uncertain(result)?;
            let mut text = format!("Avec les {} nombres incertains de {} ({} machines tirées, calculées en {} endroits), l’outil s’écarte, tel que programmé, jusqu’à {}", u.numbers, u.file, u.machines, u.places, nombre(&u.before));
            if let Some(after) = &u.after {
                text.push_str(&format!(", et jusqu’à {} avec le programme compensé", nombre(after)));
            }
            text.push_str(&format!(" (moyenne et écart-type ; dix-neuf machines sur vingt restent sous {}).", nombre(&u.high)));
            if !u.linear {
                text.push_str(" Ces écarts ne sont pas linéaires dans ces nombres : la propagation linéaire ne suffit pas.");
            }
            if u.unanswered > 0 {
                text.push_str(&format!(" {} de ces machines sont quelque part sans solution et ne sont pas dans ces valeurs.", u.unanswered));
            }
            if u.unstable > 0 {
                text.push_str(&format!(" {} DE CES MACHINES NE SONT PAS STABLES quelque part sur le programme.", u.unstable));
            }
            text
        }
        // Chatter has its own section in this language.
        Statement::Assumed(AssumptionKind::Chatter) => return None,
        // A kind without words in this language is quoted in English.
        Statement::Assumed(kind) => assumed(result, *kind),
        Statement::Tilt => {
            let angle = nombre(&result.figures.rotation);
            let inputs = &result.run_inputs;
            match (inputs.compensated, inputs.orientation_corrected, inputs.states_orientation) {
                (false, ..) => format!("Il s’incline jusqu’à {angle}."),
                (true, true, _) => format!("L’outil reste incliné jusqu’à {angle}."),
                (true, false, true) => format!("L’outil reste incliné jusqu’à {angle}, ce que --correct pose corrige aussi."),
                (true, false, false) => format!("L’outil reste incliné jusqu’à {angle}, ce qu’un programme de positions ne peut pas corriger."),
            }
        }
    })
}
