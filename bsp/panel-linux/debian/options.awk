# Turns the output of `landmass-panel --options` into a configuration file (as=conf) or a part of
# the manual page (as=man). Of a family of like options (key.1, key.2 ...) only the first is
# explained.
function family(name) {
    return name ~ /^key\./ ? "key." : name ~ /^stick\.button\./ ? "stick.button." : name
}
function finish(    is_like) {
    if (name == "")
        return
    is_like = family(name) == last
    last = family(name)
    if (as == "man") {
        gsub(/-/, "\\-", assignment)
        gsub(/-/, "\\-", values)
        printf "%s\n.B %s\n", is_like ? ".TQ" : ".TP", assignment
        if (!is_like)
            explanation = help "\n.br\nTakes: " values
    } else {
        if (!is_like)
            printf "\n# %s\n# Takes: %s\n", help, values
        printf "#%s\n", assignment
    }
}
# In the manual page the explanation follows the last option of a family.
function explain() {
    if (as == "man" && explanation != "")
        print explanation
}
/^[^ ]/ {
    next_name = $1
    if (name != "" && family(next_name) != family(name)) {
        finish()
        explain()
    } else
        finish()
    name = next_name
    assignment = $0
    values = help = ""
    next
}
{
    sub(/^ +/, "")
    if (values == "")
        values = $0
    else
        help = help == "" ? $0 : help " " $0
}
END {
    finish()
    explain()
}
