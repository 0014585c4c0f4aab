//! What holds for every entry: all ids exist, `agrees` agrees with the printed digits, known errata
//! are called errata, and the page is one file without network.

use std::sync::OnceLock;

use kinetostat_reproduce::{Entry, IDS, Item, ReproduceError, Status, all, html, is_rounding, one};

/// Ids that the issue names.
const ASKED: [&str; 30] = [
    "table-2.1",
    "table-2.2",
    "table-2.3",
    "table-3.1",
    "table-3.2",
    "table-3.3",
    "eq-3.34",
    "eq-3.35",
    "fig-4.3",
    "fig-4.4",
    "fig-4.5",
    "fig-5.2",
    "table-4.1",
    "table-4.2",
    "table-5.1",
    "table-5.2",
    "table-5.3",
    "fig-5.5",
    "fig-5.6",
    "fig-5.7",
    "fig-5.8",
    "fig-5.11",
    "table-6.1",
    "table-6.2",
    "fig-6.6",
    "fig-6.7",
    "fig-7.5",
    "fig-7.6",
    "fig-7.7",
    "fig-7.8",
];

fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| all(|_| {}).unwrap_or_else(|e| panic!("{e}")))
}

fn entry(id: &str) -> &'static Entry {
    let found = entries().iter().find(|e| e.id == id);
    found.unwrap_or_else(|| panic!("no entry {id}"))
}

fn item(id: &str, name: &str) -> &'static Item {
    let found = entry(id).items.iter().find(|i| i.name == name);
    found.unwrap_or_else(|| panic!("{id} has no '{name}'"))
}

#[test]
fn every_id_exists_once_and_holds_numbers() {
    let ids: Vec<&str> = entries().iter().map(|e| e.id).collect();
    assert_eq!(ids, IDS);
    for id in ASKED {
        assert!(ids.contains(&id), "{id}");
    }
    for e in entries() {
        assert!(!e.title.is_empty() && !e.items.is_empty(), "{}", e.id);
        assert_eq!(IDS.iter().filter(|id| **id == e.id).count(), 1, "{}", e.id);
        let mut names: Vec<&str> = e.items.iter().map(|i| i.name.as_str()).collect();
        names.sort_unstable();
        for pair in names.windows(2) {
            // The two limit points of one shape share their names.
            let twice = pair[0] == pair[1];
            assert!(!twice || e.id == "fig-4.3", "{}: '{}' twice", e.id, pair[0]);
        }
        if e.id.starts_with("fig-") {
            assert!(!e.plots.is_empty(), "{} has no plot", e.id);
        }
    }
    assert!(matches!(one("table-9.9"), Err(ReproduceError::Unknown(_))));
}

#[test]
fn figure_statuses_are_what_they_say() {
    let mut compared = 0;
    for e in entries() {
        for i in &e.items {
            let label = format!("{}, {}", e.id, i.name);
            assert!(!i.computed.is_some_and(f64::is_nan), "{label}");
            match i.status {
                Status::NoPrint => assert_eq!(i.printed, None, "{label}"),
                Status::Agrees => {
                    let printed = i.printed.as_deref().expect(&label);
                    let number = printed.parse::<f64>().is_ok_and(f64::is_finite);
                    if number {
                        compared += 1;
                        let computed = i.computed.expect(&label);
                        assert!(is_rounding(printed, computed), "{label}: {computed}");
                    }
                }
                Status::Erratum | Status::NotReproduced => {
                    assert!(i.printed.is_some(), "{label}");
                    assert!(!i.note.is_empty(), "{label}: no reason");
                    // The note names the entry of the errata: "erratum 3.26: ...".
                    let entry = i.note.strip_prefix("erratum ");
                    let named = entry
                        .and_then(|n| n.split_once(':'))
                        .is_some_and(|(id, _)| {
                            id.len() <= 60 && id.bytes().any(|b| b.is_ascii_digit())
                        });
                    assert!(
                        named || i.status == Status::NotReproduced,
                        "{label}: {}",
                        i.note
                    );
                    if let (Some(p), Some(c)) = (&i.printed, i.computed) {
                        assert!(!is_rounding(p, c), "{label}: {p} agrees with {c}");
                    }
                }
            }
        }
    }
    assert!(compared >= 300, "{compared} numbers compared with print");
    println!(
        "figure {}",
        serde_json::json!({
            "name": "reproduce: printed numbers whose status `agrees` was checked digit by digit",
            "measured": compared,
            "asked": "at least 100",
            "unit": "numbers",
            "holds": compared >= 100,
        })
    );
}

#[test]
fn the_named_findings_have_their_status() {
    let of = |id: &str, name: &str| item(id, name).status;
    let k = item("table-5.2", "K, G = 0.5 G*, dx = 0 L");
    assert_eq!(
        (k.printed.as_deref(), k.status),
        (Some("8.67"), Status::Erratum)
    );
    assert!((k.computed.expect("K") - 7.464_101_615).abs() < 1e-9);
    assert_eq!(
        of("text-4.6.1", "K_x at dx = 0, G = 0.5 G*"),
        Status::Erratum
    );
    for what in ["F", "K_C", "S_c"] {
        let name = format!("Z unstable, Delta = 0.2: {what}");
        assert_eq!(of("table-5.1", &name), Status::NotReproduced);
        for shape in ["symmetric", "mirrored"] {
            let name = format!("Z unstable, Delta = 0.2, true equilibrium ({shape} Z): {what}");
            assert_eq!(of("table-5.1", &name), Status::NoPrint);
        }
        let name = format!("Z unstable, Delta = 0: {what}");
        assert_eq!(of("table-5.1", &name), Status::Erratum);
        let name = format!("Z unstable, Delta = 0, preload forgotten (th0 = 0): {what}");
        assert_eq!(of("table-5.1", &name), Status::Agrees);
        for cell in [
            "S stable, Delta = 0.2",
            "S unstable, Delta = 0.2",
            "Z stable, Delta = 0",
            "Z stable, Delta = 0.2",
        ] {
            assert_eq!(of("table-5.1", &format!("{cell}: {what}")), Status::Agrees);
        }
    }
    for cell in ["S stable", "S unstable"] {
        let locked = item("table-5.1", &format!("{cell}, Delta = 0: K_C"));
        assert_eq!(locked.status, Status::Agrees);
        assert_eq!(locked.computed, Some(f64::INFINITY), "a rigid direction");
    }
    // 11 of 12 K of Table 5.2; no S_c at G > 0.
    let table = &entry("table-5.2").items;
    let agree = table
        .iter()
        .filter(|i| i.name.starts_with("K,") && i.status == Status::Agrees);
    assert_eq!(agree.count(), 11);
    for i in table.iter().filter(|i| i.name.starts_with("S_c, ")) {
        let loaded = !i.name.contains("G = 0 G*");
        assert!(!loaded || i.status == Status::Erratum, "{}", i.name);
    }
    let inferred = table
        .iter()
        .filter(|i| i.name.starts_with("S_c as it was printed"));
    assert_eq!(inferred.filter(|i| i.status == Status::Agrees).count(), 12);
    // Table 2.3: all of b = 8; b = 16 is twice the rounded.
    for i in &entry("table-2.3").items {
        if i.name.contains(" x 8 mm, ") && i.name.contains("m/min") || i.name.contains("rounded") {
            assert_eq!(i.status, Status::Agrees, "{}", i.name);
        }
    }
    assert_eq!(
        of("table-2.3", "Monel 400, 0.2 x 16 mm, 1000 m/min"),
        Status::Erratum
    );
    // Tables of matrices: exactly the entries of the errata.
    for (id, wrong) in [
        ("table-3.1", vec![]),
        ("table-3.2", vec![]),
        ("table-3.3", vec![]),
        ("eq-3.26", vec!["K55", "K66"]),
        (
            "table-4.1",
            vec![
                "J_th^(G), row 3",
                "J_q^(G), q2, row 3",
                "J_th^(F), row 2",
                "h1 = H_qq^(G), q1 q1",
            ],
        ),
        ("table-4.2", vec!["J_q^(G), q2, row 3"]),
    ] {
        let found: Vec<&str> = entry(id)
            .items
            .iter()
            .filter(|i| i.status == Status::Erratum)
            .map(|i| i.name.as_str())
            .collect();
        assert_eq!(found, wrong, "{id}");
        let missed = |i: &&Item| i.status == Status::NotReproduced;
        assert_eq!(entry(id).items.iter().filter(missed).count(), 0, "{id}");
    }
    // Corrected equations hold where the printed ones do not.
    for (id, part) in [
        ("eq-5.33", "the corrected equation less the model"),
        ("eq-5.41", "largest difference of the corrected entries"),
        ("eq-5.42", "less the"),
    ] {
        let mut some = false;
        for i in entry(id).items.iter().filter(|i| i.name.contains(part)) {
            some = true;
            assert!(i.computed.expect("number").abs() < 1e-9, "{id} {}", i.name);
        }
        assert!(some, "{id}");
    }
}

#[test]
fn the_page_is_one_file_that_asks_nobody() {
    let mut some: Vec<Entry> = entries().to_vec();
    some[0].title = "<script>alert(1)</script>".into();
    some[0].items[0].note = "a <b> & c".into();
    let page = html(&some).expect("page");
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    for bad in [
        "<script", "http:", "https:", "src=", "url(", "@import", "NaN",
    ] {
        assert!(!page.contains(bad), "{bad}");
    }
    assert!(page.contains("a &lt;b&gt; &amp; c"));
    assert!(page.contains("default-src 'none'"));
    for e in entries() {
        assert!(page.contains(&format!("id=\"{}\"", e.id)), "{}", e.id);
    }
    let plots: usize = entries().iter().map(|e| e.plots.len()).sum();
    assert_eq!(page.matches("<svg").count(), plots);
    // Formulas are set as such, all of them.
    let formulas = page.matches("class=\"formula\">").count();
    assert!(formulas > 50, "{formulas}");
    assert_eq!(page.matches("class=\"formula\"><math ").count(), formulas);
    assert_eq!(page, html(&some).expect("page"), "the same bytes");
}
