# Completion of the command line, for bash (shell=bash) or zsh, from what the program prints: a file of
#   @verbs  and `steif --help`, then for each verb  @verb NAME  and `steif NAME --help`,
#   @methods, @problems and `steif list methods`, `steif list problems` with --csv.
/^@/ { part = substr($1, 2); verb = $2; line = 0; next }
{ line++ }
part == "verbs" && /^  [a-z0-9]+ / { verbs = verbs " " $1 }
part == "methods" || part == "problems" {
  name = $0
  gsub(/"/, "", name)
  sub(/,.*/, "", name)
  if (line > 1 && part == "methods") methods = methods " " name
  if (line > 1 && part == "problems") problems = problems " " name
}
part == "verb" && line == 1 {
  words[verb] = ($0 ~ /METHOD/ ? " $methods" : "") ($0 ~ /PROBLEM/ ? " $problems" : "")
  if (verb == "list") words[verb] = words[verb] " methods problems schemes codes"
}
part == "verb" && /^  --/ {
  options[verb] = options[verb] " " $1
  if ($2 ~ /^[a-z0-9]+(\|[A-Za-z0-9]+)+$/ || $2 ~ /^[A-Z]\|/) {
    choice = $2
    gsub(/\|/, " ", choice)
    choices[verb] = choices[verb] "      " $1 ") choices='" choice "' ;;\n"
  }
}

BEGIN { OFS = "\n" }

END {
  print (shell == "zsh" ? "#compdef steif" : "# Completion of steif for bash.")
  print "_steif() {"
  print "  local methods='" substr(methods, 2) "'"
  print "  local problems='" substr(problems, 2) "'"
  print "  local verbs='" substr(verbs, 2) "' words_of='' options='' choices=''"
  if (shell == "zsh")
    print "  local place=$((CURRENT - 1)) verb=$words[2] before=$words[CURRENT-1] word=$words[CURRENT]"
  else
    print "  local line word cut", "  # bash cuts words at : and =, which names of methods hold\n" \
          "  read -ra line <<<\"${COMP_LINE:0:COMP_POINT}.\"", "  local place=$((${#line[@]} - 1))" \
          " verb=${line[1]%.} before=${line[${#line[@]}-2]}", "  word=${line[place]%.}" 
  print "  case $verb in"
  count = split(verbs, each, " ")
  for (i = 1; i <= count; i++) {
    v = each[i]
    print "  " v ")\n    words_of=\"" substr(words[v], 2) "\"\n    options='" substr(options[v], 2) "'"
    if (choices[v]) print "    case $before in\n" choices[v] "    esac"
    print "    ;;"
  }
  print "  help) words_of=$verbs ;;\n  esac"
  print "  [ \"$place\" -eq 1 ] && words_of=\"$verbs help version\" options='--help --version'"
  if (shell == "zsh") {
    print "  if [[ -n $choices ]]; then compadd -- ${=choices}; return; fi"
    print "  if [[ $word == -* ]]; then compadd -- ${=options}; return; fi"
    print "  compadd -- ${=words_of}"
    print "  [[ $place -gt 1 ]] && _files"
    print "}\n_steif \"$@\""
  } else {
    print "  local list=$words_of"
    print "  [ -n \"$choices\" ] && list=$choices"
    print "  case $word in -*) list=$options ;; esac"
    print "  COMPREPLY=($(compgen -W \"$list\" -- \"$word\"))"
    print "  cut=${word%\"${word##*[:=]}\"}"
    print "  COMPREPLY=(\"${COMPREPLY[@]#\"$cut\"}\")"
    print "  if [ \"$place\" -gt 1 ] && [ ${#COMPREPLY[@]} -eq 0 ]; then"
    print "    COMPREPLY=($(compgen -f -- \"$word\"))"
    print "  fi\n}\ncomplete -o filenames -F _steif steif"
  }
}
