# Writes changelog.gz, that of the project, and changelog.Debian.gz, that of the package, of the day that
# SOURCE_DATE_EPOCH says or of today.
function(write_changelogs project folder)
  string(TIMESTAMP day "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(REMOVE_RECURSE ${folder})
  file(WRITE ${folder}/changelog.Debian
"bernal (${version}) ${codename}; urgency=medium

  * Made from the sources by cmake/package; changelog.gz says what changed.

 -- bernal maintainers <maintainers@bernal.invalid>  ${day}
")
  file(COPY_FILE ${project} ${folder}/changelog)
  execute_process(COMMAND gzip -9n ${folder}/changelog ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
endfunction()
