# Figs. 17 to 19: peaks of the wafer's shear from the ensemble's runs, F_tau and its models, pictures. Needs the runs of
# abrasive_free at the ensemble's spacing, too.
ENSEMBLE = load_case("abrasives").data["ensemble"]["spacings"][LEVEL][-1]
FREE = OUT / f"runs/abrasive_free/default/wafer_moves/{ENSEMBLE:g}/run.json"
TARGETS += [OUT / "abrasives.md", OUT / "abrasives_shear.png"]


rule abrasive_peaks:
    input:
        files("abrasives"),
        FREE,
    output:
        OUT / "abrasives.csv",
    shell:
        "{PYTHON} -m verification.active_shear --spacing {ENSEMBLE:g} --out {OUT} --csv {output}"


rule abrasive_report:
    input:
        OUT / "abrasives.csv",
    output:
        json=OUT / "abrasives.json",
        tables=OUT / "abrasives.md",
    shell:
        "{PYTHON} -m verification.abrasive_report --csv {input} --json {output.json} >{output.tables}"


rule abrasive_figures:
    input:
        OUT / "abrasives.json",
        csv=OUT / "abrasives.csv",
    output:
        multiext(str(OUT / "abrasives_"), "field.png", "wafer.png", "shear.png"),
    shell:
        "{PYTHON} -m verification.abrasive_figures --csv {input.csv} --out {OUT}"
