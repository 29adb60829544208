"""Prints the example's page with a real browser: A4, a few pages, text that must be there, nothing cut at the margin."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TUMBLE = ROOT / "target/debug/tumble"
MUST = ["Calibration passport, not an accredited certificate", "ACCEPTED", "How to apply it", "page 1 of", "T0205", "SHA-256"]


def text(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    if not (shutil.which("chromium") and shutil.which("pdftotext") and TUMBLE.exists()):
        print("SKIPPED: chromium, pdftotext or target/debug/tumble is missing")
        return
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([TUMBLE, "certify", ROOT / "examples/adxl203-3", "--out", f"{folder}/out", "--quiet"], check=True)
        page, pdf = f"{folder}/out/passport.html", f"{folder}/page.pdf"
        assert "<script" not in pathlib.Path(page).read_text(encoding="utf-8")
        chromium = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"]
        chromium += ["--disable-background-networking", "--disable-component-update", "--disable-sync"]
        chromium += [f"--user-data-dir={folder}/profile", "--no-pdf-header-footer", f"--print-to-pdf={pdf}", f"file://{page}"]
        subprocess.run(chromium, check=True, capture_output=True, timeout=120)
        info = text("pdfinfo", pdf)
        pages = int(re.search(r"Pages:\s+(\d+)", info).group(1))
        assert 2 <= pages <= 10, f"{pages} pages"
        assert "A4" in info, info
        words = text("pdftotext", "-layout", pdf, "-")
        missing = [m for m in MUST if m not in words]
        assert not missing, f"not on the printed page: {missing}"
        # Nothing reaches into the right margin: A4 is 595 points wide, the margin 15 mm.
        boxes = re.findall(r'xMax="([\d.]+)"', text("pdftotext", "-bbox", pdf, "-"))
        widest = max(map(float, boxes))
        assert widest <= 595.3 - 15 / 25.4 * 72 + 2, f"text reaches {widest:.0f} of 595 points"
        print(f"{pages} pages, text up to {widest:.0f} of 595 points")


sys.exit(main())
