//! The server as a browser and as a stranger see it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;

use kinetostat_view::{Answers, OPEN, PAGE, Refused, Server, exported};

type Outcome = anyhow::Result<()>;

/// Answers with what was asked.
struct Echo;

impl Answers for Echo {
    fn answer(&self, question: &str, request: &[u8]) -> Option<Result<String, Refused>> {
        match (question, request) {
            ("state" | OPEN, b"\"refuse\"") => Some(Err(Refused::new("value", "no such state"))),
            ("state" | OPEN, b"\"panic\"") => panic!("a fault of the computation"),
            ("state" | OPEN, own) => Some(Ok(String::from_utf8_lossy(own).into_owned())),
            _ => None,
        }
    }
}

/// The host of a server that runs until the test ends.
fn host() -> anyhow::Result<String> {
    let server = Server::listen(0)?;
    let url = server.url();
    std::thread::spawn(move || server.serve(Arc::new(Echo)));
    let host = url
        .strip_prefix("http://")
        .and_then(|url| url.strip_suffix('/'));
    Ok(host.map(str::to_owned).unwrap_or(url))
}

/// Status and body of the answer to a request that ends its connection.
fn answer(host: &str, request: &str) -> anyhow::Result<(u16, String)> {
    let mut stream = TcpStream::connect(host)?;
    stream.write_all(request.as_bytes())?;
    let mut text = String::new();
    stream.read_to_string(&mut text)?;
    let status = text.split(' ').nth(1).and_then(|code| code.parse().ok());
    let body = text.split_once("\r\n\r\n").map_or("", |(_, body)| body);
    Ok((status.unwrap_or(0), body.to_owned()))
}

fn get(host: &str, path: &str, headers: &str) -> anyhow::Result<(u16, String)> {
    answer(
        host,
        &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{headers}\r\n"),
    )
}

fn post(host: &str, headers: &str, body: &str) -> anyhow::Result<(u16, String)> {
    asked(host, "state", headers, body)
}

fn asked(host: &str, question: &str, headers: &str, body: &str) -> anyhow::Result<(u16, String)> {
    let length = body.len();
    answer(
        host,
        &format!(
            "POST /api/{question} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Length: {length}\r\n{headers}\r\n{body}"
        ),
    )
}

const JSON: &str = "Content-Type: application/json\r\n";

#[test]
fn the_page_and_its_answers_are_served() -> Outcome {
    let host = host()?;
    assert_eq!(get(&host, "/", "")?, (200, PAGE.to_owned()));
    assert_eq!(asked(&host, "nothing", JSON, "{}")?.0, 404);
    assert_eq!(post(&host, JSON, "{}")?, (200, "{}".to_owned()));
    let own_page = format!("{JSON}Origin: http://{host}\r\nSec-Fetch-Site: same-origin\r\n");
    assert_eq!(post(&host, &own_page, "[1]")?, (200, "[1]".to_owned()));
    let (code, body) = post(&host, JSON, "\"refuse\"")?;
    assert_eq!(
        (code, body.as_str()),
        (
            422,
            r#"{"error":{"code":"value","message":"no such state"}}"#
        )
    );
    // A fault ends one answer and nothing else.
    assert_eq!(post(&host, JSON, "\"panic\"")?.0, 500);
    assert_eq!(post(&host, JSON, "{}")?.0, 200);
    Ok(())
}

#[test]
fn strangers_are_refused() -> Outcome {
    let host = host()?;
    let evil = "GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n";
    assert_eq!(answer(&host, evil)?.0, 421);
    let twice = format!(
        "GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\nConnection: close\r\n\r\n"
    );
    assert!(matches!(answer(&host, &twice)?.0, 400 | 421));
    for headers in [
        "Origin: http://evil.example\r\n",
        "Origin: null\r\n",
        "Sec-Fetch-Site: cross-site\r\n",
    ] {
        assert_eq!(get(&host, "/", headers)?.0, 403, "{headers}");
        assert_eq!(
            post(&host, &format!("{JSON}{headers}"), "{}")?.0,
            403,
            "{headers}"
        );
    }
    // A form can be sent from any page; JSON cannot.
    for kind in [
        "",
        "Content-Type: text/plain\r\n",
        "Content-Type: application/x-www-form-urlencoded\r\n",
    ] {
        assert_eq!(post(&host, kind, "{}")?.0, 415, "{kind}");
    }
    for path in [
        "/../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/index.html",
        "/api",
        "//etc/passwd",
    ] {
        assert_eq!(get(&host, path, "")?.0, 404, "{path}");
    }
    assert_eq!(get(&host, "/api/state", "")?.0, 405);
    Ok(())
}

#[test]
fn size_time_and_number_of_requests_are_bounded() -> Outcome {
    let host = host()?;
    let (code, body) = post(&host, JSON, &"x".repeat(100_000))?;
    assert_eq!(code, 413);
    assert!(body.starts_with(r#"{"error""#), "{body}");
    let files = "x".repeat(100_000);
    assert_eq!(asked(&host, OPEN, JSON, &files)?, (200, files));
    // Without sending it: the length alone is enough.
    let huge = format!(
        "POST /api/state HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{JSON}Content-Length: 1000000000\r\n\r\n"
    );
    assert_eq!(answer(&host, &huge)?.0, 413);
    // Idle and slow ones take all places; they are given up, and the next one is answered.
    let idle: Vec<TcpStream> = (0..300)
        .map(|i| {
            let mut stream = TcpStream::connect(&host)?;
            if i % 2 == 0 {
                stream.write_all(b"GET / HT")?;
            }
            Ok(stream)
        })
        .collect::<anyhow::Result<_>>()?;
    assert_eq!(get(&host, "/", "")?.0, 200);
    drop(idle);
    Ok(())
}

#[test]
fn a_port_that_is_taken_is_named() -> Outcome {
    let first = Server::listen(0)?;
    let port: u16 = first
        .url()
        .trim_end_matches('/')
        .rsplit(':')
        .next()
        .unwrap_or_default()
        .parse()?;
    let second = Server::listen(port).err().map(|error| error.to_string());
    assert!(second.is_some_and(|said| said.contains(&port.to_string())));
    Ok(())
}

#[test]
fn an_exported_page_has_its_results_and_nothing_ends_them() {
    let page = exported(r#"{"name":"</script><script>alert(1)</script>"}"#).unwrap_or_default();
    assert!(page.contains(
        r#"<script id="kinetostat-data" type="application/json">{"name":"\u003c/script>"#
    ));
    assert!(!page.contains("<script>alert"));
    let more = page.len() - PAGE.len();
    assert!(more < 100, "the rest is the page: {more}");
}

#[test]
fn the_page_is_one_file_that_asks_nobody_else() {
    for forbidden in [
        " src=\"http",
        " href=\"http",
        "@import",
        "//cdn.",
        "fonts.googleapis",
    ] {
        assert!(!PAGE.contains(forbidden), "{forbidden}");
    }
    assert!(PAGE.len() < 1_500_000, "{} bytes", PAGE.len());
}
