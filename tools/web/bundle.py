"""bundle.py - puts the page's parts into one HTML file: bundle.py page.html page.wasm OUT

In page.html, <!-- css NAME --> and <!-- js NAME --> become the files' texts, <!-- worker NAME --> a script that is not run,
and <!-- wasm --> the module, gzipped, in base64. Scripts have their NAME as id.
"""
import base64, gzip, re, sys

page, module, out = sys.argv[1:]


def part(match):
    kind, name = match.group(1), match.group(2)
    if kind == "wasm":
        packed = gzip.compress(open(module, "rb").read(), 9, mtime=0)
        return f'<script type="text/plain" id="wasm">{base64.b64encode(packed).decode()}</script>'
    text = open(name, encoding="utf-8").read().replace("</script", "<\\/script")
    return {
        "css": f"<style>\n{text}</style>",
        "js": f'<script id="{name}">\n{text}</script>',
        "worker": f'<script type="text/plain" id="{name}">\n{text}</script>',
    }[kind]


text = re.sub(r"<!-- (css|js|worker|wasm)(?: (\S+))? -->", part, open(page, encoding="utf-8").read())
open(out, "w", encoding="utf-8").write(text)
print(f"{out}: {len(text.encode()) / 1000:.0f} KB")
