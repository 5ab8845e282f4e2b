# Writes the version header; called at build time.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty
                OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#pragma once
#define SCREE_VERSION \"${VERSION}\"
#define SCREE_REVISION \"${revision}\"
#define SCREE_SOURCE_DIR \"${SOURCE}\"
")
