//! Ce qu'un programme laisse.

use kinetostat_machining::AssumptionKind;

use crate::number;
use crate::paper::words::french::sentences::{nombre, statement};
use crate::paper::words::shared::{stated_change, uncertain_numbers};
use crate::run::facts::Left;
use crate::run::meaning::Statement;
use crate::run::shown::Shown;

/// Nom, grandeur et explication.
pub(crate) fn left(left: Left, result: &Shown<'_>) -> [String; 3] {
    let summary = &result.summary;
    let figure = nombre(&left.figure(result));
    let size = match left.counted(result) {
        Some(0) => "aucun".to_owned(),
        Some(count) if left == Left::FeedLimited => format!("{} morceaux", number::count(count)),
        Some(count) => format!("{}, le plus long {figure}", number::count(count)),
        None => figure.clone(),
    };
    let said = |s| statement(&s, result).unwrap_or_default();
    let (name, text) = match left {
        Left::Tilt => ("Inclinaison de l’outil", "La charge, le poids et les défauts de montage déplacent l’outil, et le tournent aussi. Un programme de positions ramène la pointe de l’outil à sa place mais ne peut pas la redresser ; une paroi coupée loin sous la pointe le montre.".to_owned()),
        Left::ForceOfCut => ("Effort de coupe", said(Statement::Assumed(AssumptionKind::ForceSpread))),
        Left::Uncertain => ("Machine et effort tels qu’ils peuvent être", {
            let (numbers, seed, linear, deviation) = uncertain_numbers(result);
            let linear = match linear { true => "La propagation linéaire concorde", false => "La propagation linéaire ne suffit pas : les écarts ne sont pas linéaires dans ces nombres" };
            format!("Machines tirées avec {numbers}, graine {seed}. Moyenne et écart-type du plus grand écart. {linear} (avant compensation : écart-type {}).", nombre(&deviation))
        }),
        Left::Rounding => ("Arrondi", {
            let (lengths, angles) = summary.decimals.shown(result.run_inputs.decimals, "à");
            let angles = angles.map_or_else(String::new, |angles| format!(", les angles avec {angles}"));
            format!("Les longueurs sont écrites avec {lengths} décimales{angles}. Cette part de l’écart après compensation ne vient que de là.")
        }),
        Left::CornerSteps => ("Pas aux angles", format!("Là où la charge tourne d’un coup, comme à un angle vif, la correction tourne avec elle : le programme y fait un petit pas pendant que l’outil reste à son angle. {}", said(Statement::Assumed(AssumptionKind::Corners))).trim_end().to_owned()),
        Left::EntrySteps => ("Pas en fin de rapide", "La charge est là d’un coup à la fin d’un déplacement rapide : le programme fait un pas pendant que l’outil reste à sa place.".to_owned()),
        Left::Change => ("Variation de la correction", {
            let (line, stated) = stated_change(result);
            let beside = match stated {
                None => String::new(),
                Some((stated, 0)) => format!(" ; aucune ligne ne varie plus vite que les {} indiqués (largest_step_mm_per_mm)", nombre(&stated)),
                Some((stated, lines)) => format!(". Lignes qui varient plus vite qu’indiqué : {lines} ({} à celle-ci, largest_step_mm_per_mm) ; voir les avertissements", nombre(&stated)),
            };
            format!("La plus rapide par mm de trajectoire hors des pas, d’après les positions écrites, à la ligne {line}{beside}.")
        }),
        Left::Backwards => ("Chemin à rebours", format!("Le plus long pas contre le sens du mouvement ; {} dépassent {}.", number::count(summary.backward_steps), nombre(&number::length_setting(summary.backward_step_limit_mm)))),
        Left::FeedLimited => ("Avance limitée", format!("Leur avance est limitée à {} fois celle programmée : la pièce y est coupée plus lentement que programmé, au plus lent à {figure} de la vitesse, d’abord à la ligne {}.", nombre(&number::setting(summary.max_feed_factor)), number::count(summary.feed_limited_line.unwrap_or(0)))),
    };
    [name.to_owned(), size, text]
}
