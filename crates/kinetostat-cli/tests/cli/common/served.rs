//! `kinetostat view` as the page asks it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

use serde_json::Value;

use super::BINARY;

/// A server that ends with the test.
pub struct Served {
    process: Child,
    /// Kept open: what the command prints later has somewhere to go.
    _out: BufReader<ChildStdout>,
    host: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Served {
    pub fn of(here: &Path, words: &[&str]) -> Self {
        let mut process = Command::new(BINARY)
            .arg("view")
            .args(words)
            .arg("--no-browser")
            .current_dir(here)
            .stdout(Stdio::piped())
            .spawn()
            .expect("the command runs");
        let mut line = String::new();
        let out = process.stdout.take().expect("a pipe");
        let mut out = BufReader::new(out);
        out.read_line(&mut line).expect("a line");
        let address = line.split_once("http://").map(|(_, rest)| rest);
        let host = address
            .and_then(|rest| rest.split_once('/'))
            .map(|(host, _)| host);
        let host = host
            .unwrap_or_else(|| panic!("no address: {line}"))
            .to_owned();
        Self {
            process,
            _out: out,
            host,
        }
    }

    fn answer(&self, request: &str) -> (u16, Value) {
        let mut stream = TcpStream::connect(&self.host).expect("a connection");
        stream.write_all(request.as_bytes()).expect("written");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("an answer");
        let code = text.split(' ').nth(1).and_then(|code| code.parse().ok());
        let body = text.split_once("\r\n\r\n").expect("a body").1;
        (code.unwrap_or(0), serde_json::from_str(body).expect("JSON"))
    }

    pub fn state(&self, request: &Value) -> (u16, Value) {
        self.post("state", request)
    }

    pub fn post(&self, route: &str, request: &Value) -> (u16, Value) {
        let (host, body) = (&self.host, request.to_string());
        let length = body.len();
        self.answer(&format!("POST /api/{route} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: {length}\r\n\r\n{body}"))
    }
}
