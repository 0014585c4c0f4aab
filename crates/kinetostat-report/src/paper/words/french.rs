//! Français.

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
        missing: "non connu",
        below: "moins de",
    },
    kind_compensated: "Rapport d’un programme d’usinage compensé",
    kind_analysed: "Rapport d’un programme d’usinage, analyse seule",
    kind_verified: "Rapport d’un programme d’usinage vérifié",
    title: "{program} sur {machine}",
    page_of: "page {page} sur {pages}",
    made_by: "kinetostat {version}",
    quoted: "Les nombres ont une virgule décimale. Les indications du modèle et de la commande, ainsi que les avertissements, restent dans le texte anglais du calcul, avec un point décimal.",
    not_stated: "non indiqué",
    none: "aucun",
    yes_no: ["oui", "non"],
    good: "Corrigé",
    unchanged: "Inchangé",
    analysis: "Analyse",
    attention: "Attention",
    stop: "Ne pas exécuter",
    verified: "Vérifié",
    missed: "Tolérance non tenue",
    not_verified: "Non vérifié",
    model_only: "Ces valeurs sont celles du modèle : elles sont aussi justes que ses raideurs et ses masses. Mesurez un endroit sur la machine avant de vous fier aux valeurs absolues.",
    read_back: "Les valeurs après compensation ne sont pas une prévision du compensateur : le fichier écrit a été relu et recalculé.",
    head_results: "Avant et après",
    head_features: "Élément par élément",
    head_worst: "Les lignes les plus défavorables",
    head_drives: "Charge des actionneurs",
    head_cut: "Efforts de coupe",
    head_left: "Ce qui n’est pas corrigé, et ce que les valeurs ne couvrent pas",
    head_warnings: "Avertissements",
    head_inputs: "Modèle, outil, charge et tolérances",
    head_files: "Fichiers et leurs empreintes SHA-256",
    head_signatures: "Signatures",
    date: "Date",
    program: "Programme",
    original: "Original",
    part_number: "Numéro de la pièce",
    revision: "Révision",
    machine: "Modèle de la machine",
    model_from: "Source du modèle",
    deviations: "Écarts au plan",
    stiffnesses: "Raideurs utilisées",
    load: "Charge",
    material: "Matière et effort de coupe",
    no_material: "non calculé à partir de la coupe : la charge est donnée",
    placement: "Position du programme",
    tool: "Outil",
    orientation: "Orientation de l’outil",
    path: "Longueur en avance travail",
    flat: "Mis à plat avec",
    blocks_read: "Blocs lus",
    blocks_written: "Blocs écrits",
    bytes: "{blocks} ({bytes} octets)",
    tolerance_path: "Tolérance de la trajectoire",
    tolerance_chords: "Tolérance des cordes dans les arcs",
    decimals: "Décimales écrites, au moins",
    figure: "Grandeur",
    before: "avant",
    after: "après",
    of_original: "original",
    of_verified: "ce programme",
    largest_error: "plus grand écart de position de l’outil",
    rms_error: "sa moyenne quadratique",
    allowed_in_all: "écart admis au total",
    held: "tolérance de tout le programme tenue",
    rounding: "dont par arrondi",
    largest_correction: "plus grande correction",
    tilt: "inclinaison de l’outil",
    stiffness: "plus petite raideur face à une force",
    buckling: "part de la charge de flambement (100 % : flambement)",
    no_buckling: "aucun membre de ce modèle ne peut flamber",
    speed: "écart de vitesse le long de la pièce",
    blocks_per_second: "débit maximal, blocs par seconde",
    points: "points calculés",
    stable: "stable sur tout le programme",
    feature: "Élément",
    lines: "Lignes",
    lines_to: "{first} à {last}",
    allowed: "Admis",
    verdict: "Verdict",
    kept: "tenue",
    missed_here: "NON TENUE",
    nothing_cut: "rien n’est coupé",
    picture_along: "Distance de l’outil à sa position programmée le long de la trajectoire",
    picture_above: "La trajectoire vue de dessus",
    picture_machine: "La machine à la ligne {line}, où l’outil serait le plus éloigné sans compensation",
    along_path: "longueur de la trajectoire",
    distance: "distance",
    programmed: "trajectoire programmée",
    displaced: "outil sans compensation, écart × {factor}",
    worst_note: "Où l’outil est le plus écarté sans compensation, le pire d’abord ; positions en coordonnées du programme.",
    worst_note_verified: "Où l’outil est le plus écarté avec ce programme, le pire d’abord ; positions en coordonnées du programme.",
    worst_after_note: "Où il est le plus écarté avec le programme compensé, le pire d’abord.",
    line: "Ligne",
    line_written: "Ligne écrite",
    line_from: "de {line} de {file}",
    drive: "Actionneur",
    largest_force: "Charge maximale",
    rating: "Valeur nominale",
    share: "Part",
    correction: "Plus grande correction",
    range: "Course de … à",
    limits: "Limites",
    no_ratings: "Le modèle n’indique pas de valeurs nominales des actionneurs ; les charges ne sont comparées à aucune.",
    nearest_limit: "Butée la plus proche",
    nearest_limit_text: "Plus petite distance d’une articulation à l’une de ses limites : {drive}, limite {end}, ligne {line}.",
    lower: "inférieure",
    upper: "supérieure",
    most_loaded: "Charge sur valeur nominale",
    most_loaded_text: "Plus grande force ou plus grand couple d’un actionneur, en part de la valeur nominale du modèle : {drive}, ligne {line}.",
    configuration: "Configuration du bras",
    configuration_changes: "elle change {count} fois",
    shoulder: ["épaule avant", "épaule arrière"],
    elbow: ["coude haut", "coude bas"],
    wrist: ["poignet non retourné", "poignet retourné"],
    cut_force: "Effort",
    cut_torque: "Couple",
    cut_share: "part de la broche",
    cut_power: "Puissance",
    cut_depth: "Profondeur",
    cut_spread: "Les coefficients tabulés valent à ±{percent} % près pour un autre lot ou un autre outil.",
    cut_spindle: "Le couple de la broche ne suffit pas : voir les avertissements.",
    head_chatter: "Broutement et vibrations",
    chatter_unjudged: "Aucune position n’est jugée.",
    chatter_none: "Aucune position jugée ne broute.",
    chatter_without: "Positions sans réponse : {count}.",
    chatter_some: "Les lignes suivantes broutent :",
    chatter_columns: [
        "Vitesse,\u{a0}tr/min",
        "Profondeur,\u{a0}mm",
        "Stable\u{a0}jusqu’à,\u{a0}mm",
        "Broutement,\u{a0}Hz",
        "Stable\u{a0}à,\u{a0}tr/min",
    ],
    chatter_nearest: "Profondeur limite la plus proche de la passe",
    chatter_nearest_text: "à la ligne {line}, où le programme coupe sur {depth} de profondeur",
    chatter_spread_text: " ; l’effort peut dépasser sa loi de {spread}, et la passe broute alors dès {limit}",
    shaken: "Vibration forcée de la pointe (valeur efficace)",
    shaken_text: "à la ligne {line}, surtout à {frequency}, à côté d’un mode à {mode}",
    wall: "Trace laissée sur une paroi",
    wall_text: "à la ligne {line}, {side} ; aucune compensation ne l’enlève",
    wall_sides: ["trop profond", "surépaisseur"],
    chatter_note: "Amortissement : {damping}. Les limites sont exactes pour le modèle, dans la posture de chaque position ; les modes de la broche, de l’outil et de la pièce n’y sont que si le modèle les contient.",
    not_covered: "Le calcul est statique : ni vibrations, ni broutement, ni dérive thermique, ni frottement, ni jeu. Les efforts de coupe sont ceux d’un outil qui ne fléchit pas et d’une pièce qui ne cède pas.",
    not_covered_beside_chatter: "Les écarts sont ceux de la statique : ni dérive thermique, ni frottement, ni jeu ; les vibrations seulement comme indiqué plus haut. Les efforts de coupe sont ceux d’un outil qui ne fléchit pas et d’une pièce qui ne cède pas.",
    more_warnings: "{count} autres avertissements sont dans le fichier de résultats.",
    more_features: "{count} autres éléments sont dans le fichier de résultats.",
    file_what: "Quoi",
    file_name: "Fichier",
    file_program: "programme",
    file_model: "modèle",
    file_job: "commande",
    file_material: "matière",
    file_written: "programme écrit",
    file_verified: "programme vérifié",
    signed_by: ["Calculé", "Contrôlé", "Libéré"],
    name_and_date: "nom, date",
    signature: "signature",
    uncut: [
        "La ligne {first} de l’original n’est pas coupée par ce programme : {length} de trajectoire.",
        "Les lignes {first} à {last} de l’original ne sont pas coupées par ce programme : {length} de trajectoire.",
    ],
    rapid_elsewhere: "Le déplacement rapide de la ligne {line} de ce programme passe ailleurs que celui de l’original, jusqu’à {length} plus loin.",
    extra_cut: "La ligne {line} de ce programme est un déplacement en avance travail que l’original ne fait pas : {length} de long.",
    other_word: "À la ligne {line}, ce programme a une autre avance, une autre broche, un autre outil ou un autre repère que l’original.",
};

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
        Left::Rounding => ("Arrondi", format!("Les nombres sont écrits avec {} décimales au moins : ceux qui en avaient plus les gardent. Cette part de l’écart après compensation ne vient que de là.", result.run_inputs.decimals)),
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
