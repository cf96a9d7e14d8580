"""The chapters as HTML pages, by Debian's python3-markdown: to_html.py FOLDER CHAPTER.md ..."""
import os
import re
import sys

import markdown

STYLE = """body{max-width:60em;margin:2em auto;padding:0 1em;font:16px/1.5 sans-serif;color:#222}
pre{background:#f4f4f4;padding:.7em;overflow:auto;font-size:13px;line-height:1.35}code{font-size:90%}
table{border-collapse:collapse}td,th{border:1px solid #bbb;padding:.2em .6em;text-align:left;vertical-align:top}"""
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>%s</title><style>%s</style></head>
<body><p><a href="index.html">steif: the manual</a></p>
%s
</body></html>
"""

folder = sys.argv[1]
os.makedirs(folder, exist_ok=True)
for path in sys.argv[2:]:
    with open(path, encoding="utf-8") as file:
        text = file.read()
    title = text.split("\n", 1)[0].lstrip("# ")
    text = re.sub(r"\]\((?!http)([\w/]+)\.md", r"](\1.html", text).replace("](README.html", "](index.html")
    body = markdown.markdown(text, extensions=["tables", "fenced_code", "toc"])
    name = os.path.basename(path)[:-3]
    with open(os.path.join(folder, ("index" if name == "README" else name) + ".html"), "w",
              encoding="utf-8") as file:
        file.write(PAGE % (title, STYLE, body))
