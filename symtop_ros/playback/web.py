"""Rerun's viewer for a browser, served so that it reaches nothing but this machine.

The page of the viewer asks servers on the internet for fonts, examples, a log-in and telemetry. It
has no switch for that. So it is passed on with a policy by which the browser itself refuses.
"""

import http.client
import http.server
import threading

HOST = "127.0.0.1"
KEPT = ("Content-Type", "rerun-final-length")  # headers that the viewer reads


def serve_page(page: int, data: int) -> int:
    """Serve the viewer's page, which Rerun serves at a port; return the port of this one.

    `data` is the port of the recording, the only other one that the page may connect to.
    """
    server = http.server.ThreadingHTTPServer((HOST, 0), _handler(page, data))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server.server_port


def _handler(page: int, data: int) -> type[http.server.BaseHTTPRequestHandler]:
    policy = (
        "default-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; "
        f"connect-src 'self' http://{HOST}:{data} ws://{HOST}:{data} data: blob:; "
        "form-action 'none'; frame-ancestors 'none'"
    )

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            source = http.client.HTTPConnection(HOST, page, timeout=60.0)
            try:
                source.request("GET", self.path)
                answer = source.getresponse()
                content = answer.read()
            except OSError:  # Rerun is starting or has ended
                self.send_error(503)
                return
            finally:
                source.close()
            self.send_response(answer.status)
            for name in KEPT:
                if value := answer.getheader(name):
                    self.send_header(name, value)
            self.send_header("Content-Length", str(len(content)))
            self.send_header("Content-Security-Policy", policy)
            self.send_header("Referrer-Policy", "no-referrer")
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_: object) -> None:
            """Write nothing."""

    return Handler
