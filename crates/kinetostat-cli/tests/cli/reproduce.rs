//! `kinetostat reproduce`: table, JSON, page, and what is said about a name that does not exist.

use crate::common::run;

#[test]
fn one_entry_is_a_table_and_a_summary() {
    let here = tempfile::tempdir().expect("directory");
    let said = run(here.path(), &["reproduce", "table-5.2"]).answered();
    let row = said.out.lines().find(|l| l.contains("8.67")).expect("8.67");
    assert!(
        row.contains("7.464101615") && row.contains("ERRATUM"),
        "{row}"
    );
    let last = said.out.lines().last().expect("summary");
    assert!(
        last.contains("24 agree") || last.contains("agree,"),
        "{last}"
    );
    assert!(said.err.is_empty(), "{}", said.err);
    assert!(!said.out.contains('\u{1b}'), "no colours in a pipe");
    for line in said.out.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    // A finding is a result: the exit code is 0.
    let said = run(here.path(), &["reproduce", "table-5.1"]).answered();
    assert!(said.out.contains("NOT REPRODUCED") && said.out.contains("3 not reproduced"));
    let wide = said.out.lines().find(|l| l.chars().count() > 80);
    assert_eq!(wide, None);
}

#[test]
fn json_is_a_list_and_stands_alone() {
    let here = tempfile::tempdir().expect("directory");
    let said = run(here.path(), &["reproduce", "eq-3.34", "--json"]).answered();
    let list: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
    let entry = &list[0];
    assert_eq!(list.as_array().map(Vec::len), Some(1));
    assert_eq!(entry["id"], "eq-3.34");
    let names: Vec<&str> = entry
        .as_object()
        .expect("object")
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(names, ["id", "items", "title"]);
    for item in entry["items"].as_array().expect("items") {
        let mut keys: Vec<&str> = item
            .as_object()
            .expect("item")
            .keys()
            .map(String::as_str)
            .collect();
        keys.sort_unstable();
        assert_eq!(
            keys,
            ["computed", "name", "note", "printed", "status", "unit"]
        );
        let status = item["status"].as_str().expect("status");
        assert!(["agrees", "erratum", "not-reproduced", "no-print"].contains(&status));
        assert_eq!(item["printed"].is_null(), status == "no-print");
    }
    assert!(
        said.err.contains("1 erratum,"),
        "the text goes to the standard error"
    );
}

#[test]
fn the_page_is_written_and_not_overwritten() {
    let here = tempfile::tempdir().expect("directory");
    let arguments = ["reproduce", "fig-5.7", "--html", "page.html"];
    run(here.path(), &arguments).answered();
    let page = std::fs::read_to_string(here.path().join("page.html")).expect("page");
    assert!(page.contains("<svg") && page.contains("Figure 5.7") && !page.contains("<script"));
    let again = run(here.path(), &arguments);
    assert_eq!(again.code, 1);
    assert!(again.err.contains("--force-overwrite"), "{}", again.err);
    let mut forced = arguments.to_vec();
    forced.push("--force-overwrite");
    run(here.path(), &forced).answered();
    assert_eq!(
        std::fs::read_dir(here.path()).expect("directory").count(),
        1
    );
}

#[test]
fn an_unknown_name_is_reported_with_the_nearest_and_the_list() {
    let here = tempfile::tempdir().expect("directory");
    let said = run(
        here.path(),
        &["reproduce", "tabel-5.1", "--html", "page.html"],
    );
    assert_eq!(said.code, 1);
    assert!(said.out.is_empty());
    assert!(
        said.err.contains("did you mean 'table-5.1'?"),
        "{}",
        said.err
    );
    assert!(said.err.contains("fig-7.8"), "{}", said.err);
    assert!(!here.path().join("page.html").exists());
}
