//! Who may ask: this computer, from the page that this server gave out.
//!
//! A page of the internet that is open in the same browser can send requests to any port of this computer. It cannot choose the names
//! `Host` and `Origin` of such a request, and it cannot send JSON to another origin unasked: so these three decide.

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;

use crate::answers::OPEN;
use crate::problem::{MOST_BYTES, MOST_FILE_BYTES, problem};
use crate::refused::Refused;

/// Names under which this server may be asked, with its port.
#[derive(Clone, Debug)]
pub(crate) struct Names(Vec<String>);

impl Names {
    pub fn of_port(port: u16) -> Self {
        let hosts = ["127.0.0.1", "localhost"].iter();
        Self(hosts.map(|host| format!("{host}:{port}")).collect())
    }

    /// Reason why a request is refused.
    fn refusal(&self, request: &Request) -> Option<(StatusCode, &'static str)> {
        let headers = request.headers();
        let is_own = |value: &str| self.0.iter().any(|own| own == value);
        if !one(headers, &header::HOST).is_some_and(is_own) {
            return Some((
                StatusCode::MISDIRECTED_REQUEST,
                "the host is not this computer",
            ));
        }
        let from_here = |origin: &str| origin.strip_prefix("http://").is_some_and(is_own);
        if headers.contains_key(header::ORIGIN)
            && !one(headers, &header::ORIGIN).is_some_and(from_here)
        {
            return Some((StatusCode::FORBIDDEN, "the request comes from another page"));
        }
        let site = one(headers, &header::HeaderName::from_static("sec-fetch-site"));
        if site.is_some_and(|site| site == "cross-site" || site == "same-site") {
            return Some((StatusCode::FORBIDDEN, "the request comes from another page"));
        }
        let is_json = one(headers, &header::CONTENT_TYPE).is_some_and(|kind| {
            kind.split(';')
                .next()
                .is_some_and(|kind| kind.trim() == "application/json")
        });
        let length = one(headers, &header::CONTENT_LENGTH).map(str::parse::<usize>);
        let most = match request.uri().path().strip_prefix("/api/") {
            Some(OPEN) => MOST_FILE_BYTES,
            _ => MOST_BYTES,
        };
        if length.is_some_and(|length| length.map_or(true, |length| length > most)) {
            return Some((StatusCode::PAYLOAD_TOO_LARGE, "the request is too long"));
        }
        if request.method() == Method::POST && !is_json {
            return Some((
                StatusCode::UNSUPPORTED_MEDIA_TYPE,
                "the body has to be application/json",
            ));
        }
        None
    }
}

/// The value of a header that stands once.
fn one<'h>(headers: &'h HeaderMap, name: &header::HeaderName) -> Option<&'h str> {
    let mut all = headers.get_all(name).iter();
    let first = all.next()?.to_str().ok()?;
    all.next().is_none().then_some(first)
}

/// Refuses what comes from elsewhere, and forbids the page everything that it does not need.
pub(crate) async fn guard(State(names): State<Names>, request: Request, next: Next) -> Response {
    let mut response = match names.refusal(&request) {
        Some((status, message)) => problem(status, &Refused::new("request_refused", message)),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (
            header::CONTENT_SECURITY_POLICY,
            "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        ),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}
