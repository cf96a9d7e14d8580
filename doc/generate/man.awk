# A manual page from what `steif --help` (verb not set) or `steif VERB --help` prints.
#   steif solve --help | awk -v verb=solve -v version=0.1.0 -f man.awk > steif-solve.1
function roff(text)
{
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  if (text ~ /^[.']/) text = "\\&" text
  return text
}
function section(title) { print ".SH " title }
function entry(term, about) { print ".TP\n.B " roff(term) "\n" roff(about) }

BEGIN {
  page = "STEIF" (verb ? "-" toupper(verb) : "")
  print ".TH " page " 1 \"\" \"steif " version "\" \"steif\""
}

# ---- steif(1): a line that says what it is for, then "  verb   what it does"
!verb && NR == 1 {
  about = $0
  sub(/^[^:]*: /, "", about)
  section("NAME")
  print "steif \\- " roff(about)
  section("SYNOPSIS")
  print ".B steif\n.I verb\n[\\fIwords\\fR] [\\fIoptions\\fR]"
  section("DESCRIPTION")
  print "Each verb has a page of its own, such as\n.BR steif\\-solve (1),\nand \\fBsteif \\fIverb\\fB \\-\\-help\\fR."
  next
}
!verb && /^  [a-z0-9]+ / {
  name = $1
  about = $0
  sub(/^ *[a-z0-9]+ +/, "", about)
  entry(name, about)
  next
}
!verb { next }

# ---- steif-VERB(1): usage, what it does, options, METHOD, exit codes
NR == 1 { usage = $0; next }
NR == 2 { next }
NR == 3 {
  section("NAME")
  print "steif\\-" verb " \\- " roff($0)
  section("SYNOPSIS")
  print roff(usage)
  section("OPTIONS")
  next
}
/^  --/ && state == "" {
  term = $0
  about = ""
  sub(/^ +/, "", term)
  if (match(term, /   *[^ ]/)) {
    about = substr(term, RSTART + RLENGTH - 1)
    term = substr(term, 1, RSTART - 1)
  } else if (length(term) > 28 && match(term, /^--[^ ]+ [^ ]+ [a-z]/)) {
    about = substr(term, RLENGTH)
    term = substr(term, 1, RLENGTH - 2)
  }
  if (about != "") entry(term, about)
  next
}
/^        / && state == "" && about == "" {
  about = $0
  sub(/^ +/, "", about)
  entry(term, about)
  next
}
/^METHOD:/ { state = "method"; section("METHODS") }
/^Exit codes:/ { state = "exit"; section("EXIT STATUS"); sub(/^Exit codes: /, "") }
state != "" && /^  / { print ".br" }
state != "" && NF { print roff($0) }

END {
  section("SEE ALSO")
  if (verb)
    print ".BR steif (1);\nthe manual with examples of every verb: the folder \\fImanual\\fR of steif's documentation."
  else
    print ".BR steif\\-solve (1),\n.BR steif\\-impulse (1);\nthe folder \\fImanual\\fR of steif's documentation."
}
